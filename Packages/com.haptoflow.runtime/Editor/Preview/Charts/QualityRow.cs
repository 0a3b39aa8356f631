#nullable enable
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;

namespace HaptoFlow.Preview
{
    /// <summary>A tier: what it is worth by the model's header, and what it takes on this machine.</summary>
    internal sealed class QualityRow
    {
        private QualityRow(ModelTier tier, bool isDefault, TierTiming? timing)
        {
            Name = tier.Name;
            IsDefault = isDefault;
            Timing = timing;
            LevelErrorDecibels = Figure(tier, "level_error_db");
            GoodnessOfFit = Figure(tier, "gfc_recording");
            SpectralDistanceDecibels = Figure(tier, "lsd_db");
        }

        public string Name { get; }

        public bool IsDefault { get; }

        /// <summary>Null where it was not measured yet.</summary>
        public TierTiming? Timing { get; }

        /// <summary>Generated RMS over recorded RMS, signed; null where the header does not tell.</summary>
        public double? LevelErrorDecibels { get; }

        /// <summary>Of magnitude spectra, 0 to 1; null where the header does not tell.</summary>
        public double? GoodnessOfFit { get; }

        /// <summary>RMS over 20 to 1000 Hz of the difference of the mean power spectra; null where the header does not
        /// tell.</summary>
        public double? SpectralDistanceDecibels { get; }

        /// <summary>Whether the header tells anything.</summary>
        public bool HasAccuracy =>
            LevelErrorDecibels != null || GoodnessOfFit != null || SpectralDistanceDecibels != null;

        /// <param name="timings">By the name of the tier.</param>
        public static IReadOnlyList<QualityRow> Of(
            ModelHeader header, IReadOnlyDictionary<string, TierTiming> timings) =>
            header.Tiers.Select(tier => new QualityRow(tier, tier.Name == header.DefaultTier.Name,
                timings.TryGetValue(tier.Name, out TierTiming? timing) ? timing : null)).ToArray();

        private static double? Figure(ModelTier tier, string key) => tier.Accuracy.Find(key)?.AsNumber();
    }
}
