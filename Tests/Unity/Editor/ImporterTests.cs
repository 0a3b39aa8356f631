#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using System.Text;
using System.Text.RegularExpressions;
using HaptoFlow.Editor;
using HaptoFlow.Model;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEditor;
using UnityEditor.AssetImporters;
using UnityEngine.TestTools;

namespace HaptoFlow.EditorTests
{
    public sealed class ImporterTests : EditorTest
    {
        [TestCase("truncated", "get it again")]
        [TestCase("text", "not a .haptoflow file")]
        public void ADamagedFileBecomesAnAssetAndLogsItsProblem(string damage, string message)
        {
            LogAssert.ignoreFailingMessages = true;
            string path = Import(damage + ".haptoflow", Damaged(Model().File, damage));
            Assert.That(AssetDatabase.LoadAssetAtPath<HapticModelAsset>(path), Is.Not.Null);
            Assert.That(Errors(path), Has.Length.EqualTo(1));
            Assert.That(Errors(path)[0], Does.Contain(path).And.Contain(message));
        }

        [Test]
        public void AReplacedFileIsCheckedAgain()
        {
            LogAssert.ignoreFailingMessages = true;
            byte[] sound = Model().File;
            Import("model.haptoflow", Damaged(sound, "truncated"));
            string path = Import("model.haptoflow", sound);
            Assert.That(AssetDatabase.LoadAssetAtPath<HapticModelAsset>(path).Header.Labels, Has.Count.EqualTo(20));
            Assert.That(Errors(path), Is.Empty);
        }

        private static byte[] Damaged(byte[] file, string damage) => damage == "truncated"
            ? ModelBytes.Truncated(file, file.Length - 1000)
            : System.Text.Encoding.ASCII.GetBytes("this is no model, but a text of more than 32 bytes");

        internal static string[] Errors(string path) => AssetImporter.GetImportLog(path)?.logEntries
            .Where(entry => (entry.flags & ImportLogFlags.Error) != 0).Select(entry => entry.message).ToArray() ??
            new string[0];
    }

    public sealed class MaterialImporterTests : EditorTest
    {
        private static string Text(params (string Key, object? Value)[] changes) => MaterialText.With(
            MaterialFile.Read(MaterialText.OfLabel(Model().File, "glass")),
            changes.ToDictionary(each => each.Key, each => each.Value));

        private static string ImportText(string text) => Import("glass.haptomaterial", Encoding.UTF8.GetBytes(text));

        [Test]
        public void AMaterialFileIsImportedWithItsNearestLabel()
        {
            string text = Text();
            string path = ImportText(text);
            var material = AssetDatabase.LoadAssetAtPath<HapticMaterial>(path);
            Assert.That(material.Learnt, Is.EqualTo(text));
            Assert.That(material.Description.Label, Is.EqualTo("glass"));
            Assert.That(material.Description.Learnt, Is.SameAs(material));
            Assert.That(ImporterTests.Errors(path), Is.Empty);
        }

        [TestCase("", "")]
        [TestCase("{\"format\": \"haptoflow-material\", \"version\": 1}", "expected a member \"space\"")]
        public void AnInvalidMaterialFileIsImportedAndLogsTheKey(string text, string message)
        {
            LogAssert.ignoreFailingMessages = true;
            string path = ImportText(text);
            Assert.That(AssetDatabase.LoadAssetAtPath<HapticMaterial>(path).IsLearnt, Is.False);
            Assert.That(ImporterTests.Errors(path).Single(), Does.Contain(path).And.Contain(message));
        }

        [Test]
        public void TheSummaryShowsNameNearestLabelDurationAndLicence()
        {
            MaterialSummary summary = MaterialSummary.Of(Text(("name", "bottle"), ("provenance",
                new Dictionary<string, object?>
                {
                    ["statement"] = "learnt", ["recordings"] = "one", ["licence"] = "CC BY 4.0", ["seconds"] = 12.5, ["created"] = "",
                })), Model());
            Dictionary<string, string> rows = summary.Rows.ToDictionary(row => row.Name, row => row.Value);
            Assert.That((summary.Title, summary.Problem, summary.Mismatch), Is.EqualTo(("bottle", (string?)null, (string?)null)));
            Assert.That(rows["Nearest Label"], Is.EqualTo("glass"));
            Assert.That(rows["Recording"], Is.EqualTo("12.5 s"));
            Assert.That(rows["Licence"], Is.EqualTo("CC BY 4.0"));
        }

        [Test]
        public void TheSummaryShowsWhyAMaterialCannotBeUsed()
        {
            Assert.That(MaterialSummary.Of(Text(("space", "0badcafe")), Model()).Mismatch,
                Does.Contain("learnt for another model").And.Contain("Learn it again"));
            Assert.That(MaterialSummary.Of(Text(), null).Mismatch, Does.Contain("no usable model"));
            Assert.That(MaterialSummary.Of("{}", Model()).Problem, Does.Contain("expected a member \"format\""));
        }
    }

    public sealed class ClipImporterTests : EditorTest
    {
        private const string Knock = "{\"version\":{\"major\":1,\"minor\":0,\"patch\":0}," +
            "\"metadata\":{\"project\":\"Knock\",\"editor\":\"a test\"},\"signals\":{\"continuous\":{\"envelopes\":{" +
            "\"amplitude\":[{\"time\":0,\"amplitude\":0.5,\"emphasis\":{\"amplitude\":0.7,\"frequency\":0.5}}," +
            "{\"time\":0.25,\"amplitude\":0}]}}}}";

        private static string AsHjif()
        {
            using HapticClipFile knock = HapticClipFile.Read(Encoding.UTF8.GetBytes(Knock));
            return knock.Write(HapticClipFormat.Hjif, new DateTime(2026, 1, 2));
        }

        [Test]
        public void AnHjifFileIsImportedAsAClip()
        {
            byte[] file = Encoding.UTF8.GetBytes(AsHjif());
            string path = Import("knock.hjif", file);
            var clip = AssetDatabase.LoadAssetAtPath<HapticClip>(path);
            Assert.That(clip.File, Is.EqualTo(file));
            Assert.That(clip.Problem, Is.Null);
            Assert.That(clip.Info.DurationSeconds, Is.EqualTo(0.25).Within(0.001));
            Assert.That(ImporterTests.Errors(path), Is.Empty);
        }

        [Test]
        public void AHapticFileIsImportedAsAClipOnlyWhereThatWasChosen()
        {
            string path = Import("knock.haptic", Encoding.UTF8.GetBytes(Knock));
            Assert.That(AssetDatabase.LoadAssetAtPath<HapticClip>(path), Is.Null);
            AssetDatabase.SetImporterOverride<HapticClipImporter>(path);
            var clip = AssetDatabase.LoadAssetAtPath<HapticClip>(path);
            Assert.That(clip.Info.Format, Is.EqualTo(HapticClipFormat.Haptic));
            Selection.activeObject = clip;
            Assert.That(ClipImportMenu.CanImport(), Is.True);
            ClipImportMenu.ImportSelected();
            Assert.That(AssetDatabase.LoadAssetAtPath<HapticClip>(path).Problem, Is.Null);
            Selection.activeObject = AssetDatabase.LoadAssetAtPath<HapticClip>(
                Import("knock.hjif", Encoding.UTF8.GetBytes(AsHjif())));
            Assert.That(ClipImportMenu.CanImport(), Is.False, "it needs no choice");
        }

        [TestCase("", "JSON")]
        [TestCase("{\"perceptions\":3}", "perceptions")]
        public void ADamagedFileBecomesAClipAndLogsItsProblem(string text, string message)
        {
            LogAssert.ignoreFailingMessages = true;
            string path = Import("knock.hjif", Encoding.UTF8.GetBytes(text));
            Assert.That(AssetDatabase.LoadAssetAtPath<HapticClip>(path).Problem, Does.Contain(message));
            Assert.That(ImporterTests.Errors(path).Single(), Does.Contain(path).And.Contain(message));
        }

        [Test]
        public void TheSummaryShowsDurationPointsTransientsAndWhatIsNotPlayed()
        {
            ClipSummary summary = ClipSummary.Of(Encoding.UTF8.GetBytes(Knock));
            Dictionary<string, string> rows = summary.Rows.ToDictionary(row => row.Name, row => row.Value);
            Assert.That(summary.Problem, Is.Null);
            Assert.That(rows["Format"], Does.Contain(".haptic"));
            Assert.That(rows["Duration"], Is.EqualTo("0.25 s"));
            Assert.That(rows["Points"], Does.StartWith("2 of amplitude"));
            Assert.That(rows["Transients"], Is.EqualTo("1"));
            Assert.That(rows["Made With"], Is.EqualTo("a test"));
            Assert.That(ClipSummary.Of(new byte[] { (byte)'{' }).Problem, Is.Not.Null);
        }
    }

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
            Assert.That(ModelSummary.Of(Model()).Rows.Select(row => row.Name), Has.No.Member("Level"));
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
                Is.EqualTo("0.23 ms a segment; 0.30 ms live; one in a hundred above 0.52 ms live; on a desk"));
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
            summary.Rows.Single(row => row.Name == name).Value;
    }
}
