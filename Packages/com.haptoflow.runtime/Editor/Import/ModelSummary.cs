#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using System.Runtime.CompilerServices;
using System.Security.Cryptography;
using HaptoFlow.Model;
using UnityEditor;
using UnityEditor.AssetImporters;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>A model's Inspector: its origin, its tiers with accuracy and time, its labels.</summary>
    internal sealed class ModelSummary : FileSummary
    {
        private const string AboutLabels =
            "The materials that a surface can have: name, category, stiffness of the spring " +
            "model, mean kinetic friction.";

        private bool showsLabels = true;

        private ModelSummary(string problem) => Problem = problem;

        /// <exception cref="FormatException">A measured figure is not a number.</exception>
        private ModelSummary(HapticModelAsset asset)
        {
            using HapticModel model = HapticModel.Open(asset.File);
            ModelHeader header = model.Header;
            Title = header.Name;
            Description = header.Description;
            SetRows(OriginOf(model, asset.File.Length));
            Tiers = header.Tiers.Select(TierSummary.Of).ToArray();
            Labels = header.Labels.Select(LabelRow).ToArray();
        }

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

        /// <summary>Call this in OnInspectorGUI.</summary>
        public void Draw()
        {
            if (!DrawHeading("model"))
            {
                return;
            }
            EditorGUILayout.Space();
            DrawRows();
            EditorGUILayout.Space();
            EditorGUILayout.LabelField("Tiers: accuracy and time", EditorStyles.boldLabel);
            foreach (TierSummary tier in Tiers)
            {
                DrawTier(tier);
            }
            EditorGUILayout.Space();
            showsLabels = EditorGUILayout.Foldout(
                showsLabels, new GUIContent($"Labels ({Labels.Count})", AboutLabels), true);
            using (new EditorGUI.IndentLevelScope())
            {
                foreach (SummaryRow row in showsLabels ? Labels : new SummaryRow[0])
                {
                    EditorGUILayout.LabelField(row.Name, row.Value);
                }
            }
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

    /// <summary>The text of a tier, as far as the file contains these figures.</summary>
    /// <param name="Network">Kind, solver and number of weights.</param>
    /// <param name="Accuracy">Measured against recordings that were not used in training.</param>
    /// <param name="Time">Milliseconds for a segment of 100 ms, and the machine on which they were measured.</param>
    internal sealed record TierSummary(string Name, string Network, string Accuracy, string Time)
    {
        private static readonly (string Key, string Format)[] AccuracyFigures =
        {
            ("level_error_db", "level error {0:+0.00;-0.00;0.00} dB"),
            ("level_error_p90_db", "level error, nine in ten below {0:0.0} dB"),
            ("gfc_recording", "spectral fit {0:0.000} of 1"),
            ("lsd_db", "spectral distance {0:0.0} dB"),
            ("f0_error_percent", "pitch error {0:0.0} %"),
            ("drift_db_per_min", "drift {0:0.00} dB a minute"),
        };

        private static readonly (string Key, string Format)[] TimeFigures =
        {
            ("ms_p50", "{0:0.00} ms a segment"),
            ("ms_live_p50", "{0:0.00} ms live"),
            ("ms_live_p99", "one in a hundred above {0:0.00} ms live"),
        };

        public static TierSummary Of(HapticTier tier)
        {
            JsonValue cost = JsonValue.Parse(tier.CostJson);
            string time = Figures(cost, TimeFigures);
            string machine = time.Length > 0 && cost.Find("machine")?.Text is { } name ? "; on " + name : "";
            return new TierSummary(tier.IsDefault ? tier.Name + " (default)" : tier.Name, NetworkOf(tier),
                OrNotMeasured(Figures(JsonValue.Parse(tier.AccuracyJson), AccuracyFigures)), OrNotMeasured(time + machine));
        }

        private static string NetworkOf(HapticTier tier)
        {
            string work = tier.Kind == "direct"
                ? "direct, one evaluation"
                : SummaryRow.Format("{0}, {1} with {2} {3}", tier.Kind, tier.Solver.ToString().ToLowerInvariant(), tier.Steps,
                    tier.Steps == 1 ? "step" : "steps");
            return SummaryRow.Format("{0}, {1:0.00} million weights", work, tier.ParameterCount / 1e6);
        }

        private static string Figures(JsonValue json, IEnumerable<(string Key, string Format)> figures) =>
            string.Join("; ", figures.Where(figure => json.Find(figure.Key) is { IsNull: false })
                .Select(figure => SummaryRow.Format(figure.Format, json[figure.Key].AsNumber())));

        private static string OrNotMeasured(string figures) => figures.Length > 0 ? figures : "not measured";
    }

    /// <summary>Lets the native library check .haptoflow files.</summary>
    internal static class ModelCheck
    {
        private static readonly ConditionalWeakTable<byte[], Answer> Known = new ConditionalWeakTable<byte[], Answer>();

        /// <summary>Null for a valid file. Each file is checked once.</summary>
        public static FileProblem? ProblemOf(byte[] file) => Known.GetValue(file, each => new Answer(each)).Problem;

        private sealed class Answer
        {
            public Answer(byte[] file)
            {
                try
                {
                    using HapticModel model = HapticModel.Open(file);
                }
                catch (HaptoFlowException refusal)
                {
                    Problem = FileProblem.Of(refusal, file);
                }
            }

            public FileProblem? Problem { get; }
        }
    }

    /// <summary>Why a model or a material file cannot be used here.</summary>
    /// <param name="Text">The problem and its remedy. Of a file that the native library could not be asked about, also
    /// what identifies it: its size and its SHA-256 checksum.</param>
    /// <param name="WasChecked">False where the native library could not be asked, so that the file may be
    /// good.</param>
    internal sealed record FileProblem(string Text, bool WasChecked)
    {
        public static FileProblem Of(HaptoFlowException refusal, byte[] file)
        {
            bool wasChecked = refusal.Status != HaptoFlowStatus.LibraryUnavailable &&
                refusal.Status != HaptoFlowStatus.LibraryMismatch;
            return new FileProblem(wasChecked ? refusal.Message : refusal.Message + Identity(file), wasChecked);
        }

        /// <summary>Logs the problem of an imported file: an error, or a warning where the file may be good.</summary>
        public void Log(AssetImportContext ctx, Object asset)
        {
            string message = $"HaptoFlow: {ctx.assetPath}: {Text}";
            if (WasChecked)
            {
                ctx.LogImportError(message, asset);
            }
            else
            {
                ctx.LogImportWarning(message, asset);
            }
        }

        private static string Identity(byte[] file)
        {
            using SHA256 hash = SHA256.Create();
            string sum = BitConverter.ToString(hash.ComputeHash(file)).Replace("-", "").ToLowerInvariant();
            return SummaryRow.Format(". The file was not checked; it has {0} bytes and the SHA-256 checksum {1}",
                file.Length, sum);
        }
    }

    [CustomEditor(typeof(HapticModelImporter))]
    internal sealed class HapticModelImporterEditor : FileInspector
    {
        private ModelSummary? view;

        public override void OnEnable()
        {
            base.OnEnable();
            view = assetTarget is HapticModelAsset asset ? ModelSummary.Of(asset) : null;
        }

        public override void OnInspectorGUI()
        {
            if (view == null)
            {
                DrawNotImported();
                return;
            }
            view.Draw();
        }
    }

    /// <summary>The Inspector of a model asset that has no .haptoflow file.</summary>
    [CustomEditor(typeof(HapticModelAsset))]
    internal sealed class HapticModelAssetEditor : UnityEditor.Editor
    {
        private ModelSummary? view;

        public override void OnInspectorGUI()
        {
            view ??= ModelSummary.Of((HapticModelAsset)target);
            view.Draw();
        }
    }
}
