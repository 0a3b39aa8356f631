#nullable enable
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;

namespace HaptoFlow.Preview
{
    /// <summary>The accuracy of a tier by the model's header, and its time on this machine.</summary>
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
            header.Tiers.Select(tier => new QualityRow(tier, tier.Name == header.DefaultTier.Name,
                timings.TryGetValue(tier.Name, out TierTiming? timing) ? timing : null)).ToArray();

        private static double? Figure(ModelTier tier, string key) => tier.Accuracy.Find(key)?.AsNumber();
    }
}
