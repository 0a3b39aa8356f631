#nullable enable
using System.Linq;
using System.Text.RegularExpressions;
using HaptoFlow.Editor;
using NUnit.Framework;

namespace HaptoFlow.EditorTests
{
    public sealed class ModelSummaryTests : EditorTest
    {
        [Test]
        public void TheSummaryShowsProvenanceAndLicence()
        {
            ModelSummary summary = ModelSummary.Of(Model());
            Assert.That(summary.Problem, Is.Null);
            Assert.That(Value(summary, "Provenance"), Is.EqualTo("trained on synthetic recordings"));
            Assert.That(Value(summary, "Licence"), Is.EqualTo("MIT"));
            Assert.That(Value(summary, "Trained speeds"), Does.Match("^[0-9.]+ to [0-9.]+ m/s$"));
            Assert.That(Value(summary, "Trained forces"), Does.Match("^[0-9.]+ to [0-9.]+ N$"));
        }

        [Test]
        public void AnAssumedLevelIsShownAndAMeasuredOneIsNotMentioned()
        {
            byte[] file = ModelBytes.WithHeader(Model().File, header => Regex.Replace(
                Regex.Replace(header, "\"statement\":\\s*\"[^\"]*\"", "\"statement\":\"imported; level assumed: a median\""),
                "\"unit\":\\s*\"m/s\\^2\"", "\"unit\":\"m/s^2\",\"assumed\":true"));
            ModelSummary assumed = ModelSummary.Of(HapticModelAsset.Create(file));
            Assert.That(Value(assumed, "Level"), Is.EqualTo("level assumed"));
            Assert.That(Value(assumed, "Provenance"), Is.EqualTo("imported; level assumed: a median"));
            Assert.That(ModelSummary.Of(Model()).Origin.Select(row => row.Name), Has.No.Member("Level"));
        }

        [Test]
        public void EveryLabelShowsItsCategoryAndStiffness()
        {
            ModelSummary summary = ModelSummary.Of(Model());
            Assert.That(summary.Labels, Has.Count.EqualTo(20));
            SummaryRow wood = summary.Labels.Single(row => row.Name == "wood");
            Assert.That(wood.Value, Does.StartWith("wood, 1200 N/m, friction 0."));
            Assert.That(summary.Labels.Single(row => row.Name == "corduroy").Value, Does.Contain("period"));
        }

        [Test]
        public void MissingFiguresAreShownAsNotMeasured()
        {
            ModelSummary summary = Summary("{}", "{}");
            Assert.That(summary.Tiers.Select(tier => tier.Accuracy), Is.All.EqualTo("not measured"));
            Assert.That(summary.Tiers.Select(tier => tier.Time), Is.All.EqualTo("not measured"));
        }

        [Test]
        public void MeasuredFiguresAreShownWithTheirUnits()
        {
            ModelSummary summary = Summary(
                "{\"level_error_db\":-0.25,\"gfc_recording\":0.9714,\"lsd_db\":3.1}",
                "{\"machine\":\"a desk\",\"ms_p50\":0.231,\"ms_live_p50\":0.3,\"ms_live_p99\":0.52}");
            Assert.That(summary.Tiers[0].Accuracy,
                Is.EqualTo("level error -0.25 dB; spectral fit 0.971 of 1; spectral distance 3.1 dB"));
            Assert.That(summary.Tiers[0].Time,
                Is.EqualTo("0.23 ms a segment; 0.30 ms live, one in a hundred above 0.52; on a desk"));
        }

        [Test]
        public void TheDefaultTierIsMarked()
        {
            ModelSummary summary = ModelSummary.Of(Model());
            string[] named = summary.Tiers.Select(tier => tier.Name)
                .Where(name => name.EndsWith("(default)")).ToArray();
            Assert.That(named, Is.EqualTo(new[] { Model().Header.DefaultTier.Name + " (default)" }));
            Assert.That(summary.Tiers[0].Network, Does.Contain("million weights"));
        }

        [Test]
        public void AFigureThatIsNotANumberIsReportedAsAProblem()
        {
            ModelSummary summary = Summary("{\"lsd_db\":\"low\"}", "{}");
            Assert.That(summary.Problem, Does.Contain("lsd_db is not a number"));
            Assert.That(summary.Labels, Is.Empty);
        }

        private static ModelSummary Summary(string accuracyJson, string costJson) =>
            ModelSummary.Of(HapticModelAsset.Create(ModelBytes.WithFigures(Model().File, accuracyJson, costJson)));

        private static string Value(ModelSummary summary, string name) =>
            summary.Origin.Single(row => row.Name == name).Value;
    }
}
