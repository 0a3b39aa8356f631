#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Model;

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
}
