#nullable enable
using System.Collections.Generic;
using System.Linq;
using System.Text;
using HaptoFlow.Editor;
using HaptoFlow.Model;
using NUnit.Framework;
using UnityEditor;
using UnityEditor.AssetImporters;
using UnityEngine.TestTools;

namespace HaptoFlow.EditorTests
{
    public sealed class MaterialImporterTests : EditorTest
    {
        private static string Text(params (string Key, object? Value)[] changes) => MaterialText.With(
            MaterialFile.Read(MaterialText.OfLabel(Model().File, "glass")),
            changes.ToDictionary(each => each.Key, each => each.Value));

        private static string ImportText(string text) => Import("glass.haptomaterial", Encoding.UTF8.GetBytes(text));

        private static string[] Errors(string path) => AssetImporter.GetImportLog(path)?.logEntries
            .Where(entry => (entry.flags & ImportLogFlags.Error) != 0).Select(entry => entry.message).ToArray() ??
            new string[0];

        [Test]
        public void AMaterialFileIsImportedWithItsNearestLabel()
        {
            string text = Text();
            string path = ImportText(text);
            var material = AssetDatabase.LoadAssetAtPath<HapticMaterial>(path);
            Assert.That(material.Learnt, Is.EqualTo(text));
            Assert.That(material.Description.Label, Is.EqualTo("glass"));
            Assert.That(material.Description.Learnt, Is.SameAs(material));
            Assert.That(Errors(path), Is.Empty);
        }

        [TestCase("", "")]
        [TestCase("{\"format\": \"haptoflow-material\", \"version\": 1}", "expected a member \"space\"")]
        public void AnInvalidMaterialFileIsImportedAndLogsTheKey(string text, string message)
        {
            LogAssert.ignoreFailingMessages = true;
            string path = ImportText(text);
            Assert.That(AssetDatabase.LoadAssetAtPath<HapticMaterial>(path).IsLearnt, Is.False);
            Assert.That(Errors(path).Single(), Does.Contain(path).And.Contain(message));
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
}
