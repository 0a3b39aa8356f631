#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The text of a model's Inspector: its origin, its tiers with accuracy and time, its labels.</summary>
    internal sealed class ModelSummary
    {
        private ModelSummary(string problem) => Problem = problem;

        /// <exception cref="FormatException">A measured figure is not a number.</exception>
        private ModelSummary(HapticModelAsset asset)
        {
            using HapticModel model = HapticModel.Open(asset.File);
            ModelHeader header = model.Header;
            Title = header.Name;
            Description = header.Description;
            Origin = OriginOf(model, asset.File.Length).Where(row => row.Value.Length > 0).ToArray();
            Tiers = header.Tiers.Select(tier => new TierSummary(tier)).ToArray();
            Labels = header.Labels.Select(LabelRow).ToArray();
        }

        /// <summary>The problem of a file that cannot be used, with all other properties empty; else null.</summary>
        public string? Problem { get; }

        public string Title { get; } = "";
        public string Description { get; } = "";
        public IReadOnlyList<SummaryRow> Origin { get; } = new SummaryRow[0];

        /// <summary>The tiers in the order of the file, the most accurate last.</summary>
        public IReadOnlyList<TierSummary> Tiers { get; } = new TierSummary[0];

        public IReadOnlyList<SummaryRow> Labels { get; } = new SummaryRow[0];

        public static ModelSummary Of(HapticModelAsset asset)
        {
            FileProblem? problem = ModelCheck.ProblemOf(asset.File);
            if (problem != null)
            {
                return new ModelSummary(problem.Text);
            }
            try
            {
                return new ModelSummary(asset);
            }
            catch (FormatException error)
            {
                return new ModelSummary("the JSON header: " + error.Message);
            }
        }

        private static IEnumerable<SummaryRow> OriginOf(HapticModel model, int bytes)
        {
            ModelHeader header = model.Header;
            yield return new SummaryRow("Provenance", header.Provenance.Statement);
            yield return new SummaryRow("Recordings", header.Provenance.Recordings);
            yield return new SummaryRow("Licence", header.Provenance.Licence);
            yield return new SummaryRow("Created", header.Provenance.Created);
            yield return new SummaryRow("Training code", header.Provenance.Commit);
            yield return new SummaryRow("Trained speeds", Interval(header.SpeedMps, "m/s"));
            yield return new SummaryRow("Trained forces", Interval(header.ForceNewtons, "N"));
            yield return new SummaryRow("Level", IsLevelAssumed(model) ? "level assumed" : "");
            yield return new SummaryRow("Size", SummaryRow.Format("{0:0.0} MB", bytes / 1e6));
        }

        /// <summary>True if the model's level is a guess: whoever made the file did not know how strong its vibrations
        /// are.</summary>
        private static bool IsLevelAssumed(HapticModel model) =>
            JsonValue.Parse(model.HeaderJson()).Find("normalisation")?.Find("assumed")?.Truth ?? false;

        private static SummaryRow LabelRow(HapticLabel label)
        {
            string wave = label.WavelengthMetres.HasValue
                ? SummaryRow.Format(", period {0:0.##} mm", 1000.0 * label.WavelengthMetres.Value)
                : "";
            return new SummaryRow(label.Name, SummaryRow.Format("{0}, {1:0} N/m, friction {2:0.00}{3}",
                label.Category, label.StiffnessNewtonsPerMetre, label.FrictionCoefficient, wave));
        }

        private static string Interval(TrainedInterval interval, string unit) =>
            SummaryRow.Format("{0:0.##} to {1:0.##} {2}", interval.Minimum, interval.Maximum, unit);
    }

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

    /// <summary>Draws the summary of a model.</summary>
    internal sealed class ModelSummaryView
    {
        private readonly ModelSummary summary;
        private readonly GUIContent labelsTitle;
        private bool showsLabels = true;

        public ModelSummaryView(ModelSummary summary)
        {
            this.summary = summary;
            labelsTitle = new GUIContent($"Labels ({summary.Labels.Count})",
                "The materials that a surface can have: name, category, stiffness of the spring model, mean kinetic " +
                "friction.");
        }

        public void Draw()
        {
            if (summary.Problem != null)
            {
                EditorGUILayout.HelpBox("This model cannot be used: " + summary.Problem, MessageType.Error);
                return;
            }
            EditorGUILayout.LabelField(summary.Title, EditorStyles.boldLabel);
            EditorGUILayout.LabelField(summary.Description, EditorStyles.wordWrappedLabel);
            EditorGUILayout.Space();
            foreach (SummaryRow row in summary.Origin)
            {
                EditorGUILayout.LabelField(row.Name, row.Value, EditorStyles.wordWrappedLabel);
            }
            EditorGUILayout.Space();
            EditorGUILayout.LabelField("Tiers: accuracy and time", EditorStyles.boldLabel);
            foreach (TierSummary tier in summary.Tiers)
            {
                DrawTier(tier);
            }
            EditorGUILayout.Space();
            DrawLabels();
        }

        private static void DrawTier(TierSummary tier)
        {
            EditorGUILayout.LabelField(tier.Name, tier.Network, EditorStyles.wordWrappedLabel);
            using (new EditorGUI.IndentLevelScope())
            {
                EditorGUILayout.LabelField("Accuracy", tier.Accuracy, EditorStyles.wordWrappedLabel);
                EditorGUILayout.LabelField("Time", tier.Time, EditorStyles.wordWrappedLabel);
            }
        }

        private void DrawLabels()
        {
            showsLabels = EditorGUILayout.Foldout(showsLabels, labelsTitle, true);
            if (!showsLabels)
            {
                return;
            }
            using (new EditorGUI.IndentLevelScope())
            {
                foreach (SummaryRow row in summary.Labels)
                {
                    EditorGUILayout.LabelField(row.Name, row.Value);
                }
            }
        }
    }
}
