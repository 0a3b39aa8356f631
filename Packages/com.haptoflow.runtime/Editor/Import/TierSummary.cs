#nullable enable
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;

namespace HaptoFlow.Editor
{
    /// <summary>The text of a tier: its network, its accuracy against recordings, and its time, as far as the file
    /// contains these figures.</summary>
    internal sealed class TierSummary
    {
        private const string NotMeasured = "not measured";

        private static readonly (string Key, string Words, string Format)[] AccuracyFigures =
        {
            ("level_error_db", "level error", "{0} {1:+0.00;-0.00;0.00} dB"),
            ("level_error_p90_db", "level error, nine in ten below", "{0} {1:0.0} dB"),
            ("gfc_recording", "spectral fit", "{0} {1:0.000} of 1"),
            ("lsd_db", "spectral distance", "{0} {1:0.0} dB"),
            ("f0_error_percent", "pitch error", "{0} {1:0.0} %"),
            ("drift_db_per_min", "drift", "{0} {1:0.00} dB a minute"),
        };

        public TierSummary(HapticTier tier)
        {
            Name = tier.IsDefault ? tier.Name + " (default)" : tier.Name;
            Network = NetworkOf(tier);
            Accuracy = AccuracyOf(JsonValue.Parse(tier.AccuracyJson));
            Time = TimeOf(JsonValue.Parse(tier.CostJson));
        }

        public string Name { get; }

        /// <summary>Kind, solver and number of weights.</summary>
        public string Network { get; }

        /// <summary>Measured against recordings that were not used in training.</summary>
        public string Accuracy { get; }

        /// <summary>Milliseconds for a segment of 100 ms, and the machine on which they were measured.</summary>
        public string Time { get; }

        private static string NetworkOf(HapticTier tier)
        {
            string work = tier.Kind == "direct"
                ? "direct, one evaluation"
                : SummaryRow.Format("{0}, {1} with {2} {3}", tier.Kind, tier.Solver.ToString().ToLowerInvariant(), tier.Steps,
                    tier.Steps == 1 ? "step" : "steps");
            return SummaryRow.Format("{0}, {1:0.00} million weights", work, tier.ParameterCount / 1e6);
        }

        private static string AccuracyOf(JsonValue accuracy)
        {
            IEnumerable<string> known = AccuracyFigures
                .Where(figure => accuracy.Find(figure.Key) is { IsNull: false })
                .Select(figure => SummaryRow.Format(figure.Format, figure.Words, accuracy[figure.Key].AsNumber()));
            return Joined(known);
        }

        private static string TimeOf(JsonValue cost)
        {
            var known = new List<string>();
            if (cost.Find("ms_p50") is { IsNull: false } hot)
            {
                known.Add(SummaryRow.Format("{0:0.00} ms a segment", hot.AsNumber()));
            }
            if (cost.Find("ms_live_p50") is { IsNull: false } live)
            {
                string worst = cost.Find("ms_live_p99") is { IsNull: false } rare
                    ? SummaryRow.Format(", one in a hundred above {0:0.00}", rare.AsNumber())
                    : "";
                known.Add(SummaryRow.Format("{0:0.00} ms live{1}", live.AsNumber(), worst));
            }
            if (known.Count > 0 && cost.Find("machine") is { IsNull: false } machine)
            {
                known.Add("on " + machine.AsText());
            }
            return Joined(known);
        }

        private static string Joined(IEnumerable<string> figures)
        {
            string all = string.Join("; ", figures);
            return all.Length > 0 ? all : NotMeasured;
        }
    }
}
