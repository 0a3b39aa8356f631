#nullable enable
using System;
using System.Linq;

namespace HaptoFlow.Model
{
    /// <summary>Limits of the numbers in a material file, as specified in own-materials.md.</summary>
    internal static class MaterialRules
    {
        public const double MaximumOffsetDecibels = 24.0;

        private const int MaximumSeeds = 16;
        private const int SeedSamples = 400;
        private const double SeedRmsTolerance = 0.02;
        private const int MaximumLevelSpeeds = 16;
        private const int MaximumToneSpeeds = 8;
        private const int MaximumToneFrequencies = 32;
        private const double MaximumToneDecibels = 30.0;

        /// <exception cref="FormatException">A rule is broken; the message names the key.</exception>
        public static void Check(CheckedTable root)
        {
            CheckedTable range = root.Table("range");
            range.Rising("speed_mps", 2, 2, 0.0, 100.0, true);
            range.Rising("force_newtons", 2, 2, 0.0, 1000.0, true);
            CheckedTable exponents = root.Table("level_exponents");
            exponents.Number("speed", -10.0, 10.0);
            exponents.Number("force", -10.0, 10.0);
            root.Number("frequency_exponent", -4.0, 4.0);
            if (root.Boolean("periodic") != root.OptionalNumber("wavelength_metres", 1e-6, 1.0).HasValue)
            {
                throw root.Failure("periodic", "true exactly where 'wavelength_metres' is a number");
            }
            root.Number("friction_coefficient", 0.0, 10.0);
            CheckImpact(root.OptionalTable("impact"));
            CheckLevel(root.OptionalTable("level"));
            CheckTone(root.OptionalTable("tone"));
            foreach (CheckedTable seed in root.Tables("seeds", 0, MaximumSeeds))
            {
                CheckSeed(seed);
            }
        }

        private static void CheckImpact(CheckedTable? impact)
        {
            if (impact == null)
            {
                return;
            }
            foreach (CheckedTable mode in impact.Tables("modes", 1, 2))
            {
                mode.Number("frequency_hz", 1.0, 1000.0);
                mode.Number("decay_per_second", 10.0, 10000.0);
                mode.Number("gain_per_second", 0.0, 10000.0);
            }
            impact.Number("restitution", 0.0, 0.9);
        }

        private static void CheckLevel(CheckedTable? level)
        {
            if (level == null)
            {
                return;
            }
            int speeds = level.Rising("speeds_mps", 1, MaximumLevelSpeeds, 0.0, 100.0).Length;
            level.Numbers("log_levels", speeds, speeds, -30.0, 10.0);
            level.Number("force_newtons", 0.01, 100.0);
            level.Number("force_exponent", -4.0, 4.0);
        }

        private static void CheckTone(CheckedTable? tone)
        {
            if (tone == null)
            {
                return;
            }
            int speeds = tone.Rising("speeds_mps", 1, MaximumToneSpeeds, 1e-6, 100.0).Length;
            int frequencies = tone.Rising("frequencies_hz", 2, MaximumToneFrequencies, 10.0, 1000.0).Length;
            tone.CheckRows("gains_db", speeds, frequencies, -MaximumToneDecibels, MaximumToneDecibels);
        }

        private static void CheckSeed(CheckedTable seed)
        {
            double[] samples = seed.Numbers("samples", SeedSamples, SeedSamples);
            double rms = Math.Sqrt(samples.Average(sample => sample * sample));
            if (Math.Abs(rms - 1.0) > SeedRmsTolerance)
            {
                throw seed.Failure("samples", FormattableString.Invariant($"an RMS of 1, not {rms:0.###}"),
                    "divide the samples by their RMS");
            }
            if (seed.Has("rib_phase"))
            {
                seed.Numbers("rib_phase", 2, 2, 0.0, 1.0);
            }
            seed.Numbers("velocity_mps", 2, 2, -100.0, 100.0);
            seed.Number("force_newtons", 0.0, 1000.0);
        }
    }
}
