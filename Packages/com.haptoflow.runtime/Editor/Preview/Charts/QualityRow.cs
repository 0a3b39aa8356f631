#nullable enable
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;

namespace HaptoFlow.Preview
{
    /// <summary>The accuracy of a tier by the model's header, and its time on this machine.</summary>
    internal sealed class QualityRow
    {
        private QualityRow(HapticTier tier, TierTiming? timing)
        {
            Name = tier.Name;
            IsDefault = tier.IsDefault;
            Timing = timing;
            JsonValue accuracy = JsonValue.Parse(tier.AccuracyJson);
            LevelErrorDecibels = accuracy.Find("level_error_db")?.AsNumber();
            GoodnessOfFit = accuracy.Find("gfc_recording")?.AsNumber();
            SpectralDistanceDecibels = accuracy.Find("lsd_db")?.AsNumber();
        }

        public string Name { get; }

        public bool IsDefault { get; }

        /// <summary>Null until it was measured.</summary>
        public TierTiming? Timing { get; }

        /// <summary>Ratio of generated to recorded RMS, in decibels; null if the header has no value.</summary>
        public double? LevelErrorDecibels { get; }

        /// <summary>GFC of the magnitude spectra, 0 to 1; null if the header has no value.</summary>
        public double? GoodnessOfFit { get; }

        /// <summary>LSD: RMS over 20 to 1000 Hz of the difference of the mean power spectra; null if the header has no
        /// value.</summary>
        public double? SpectralDistanceDecibels { get; }

        /// <summary>True if the header has at least one of the three values.</summary>
        public bool HasAccuracy =>
            LevelErrorDecibels != null || GoodnessOfFit != null || SpectralDistanceDecibels != null;

        /// <param name="timings">By name of the tier.</param>
        public static IReadOnlyList<QualityRow> Of(
            ModelHeader header, IReadOnlyDictionary<string, TierTiming> timings) =>
            header.Tiers.Select(tier => new QualityRow(tier,
                timings.TryGetValue(tier.Name, out TierTiming? timing) ? timing : null)).ToArray();
    }
}
