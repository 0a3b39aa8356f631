using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Reflection;
using System.Text.RegularExpressions;
using HaptoFlow.Studies;
using HaptoFlow.Samples.SimilarityStudy;
using HaptoFlow.Tests;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests.Similarity
{
    /// <summary>The scene file and the settings asset of the sample.</summary>
    public sealed class SimilarityAssetTests : SimilarityTest
    {
        private static string Asset => File.ReadAllText(SampleFiles.In("SimilarityStudy", "SimilarityStudySettings.asset"));

        [Test]
        public void TheSettingsAssetContainsEveryFieldExactlyOnce()
        {
            IEnumerable<string> keys = Regex.Matches(Asset, @"^  ([a-z]\w*):", RegexOptions.Multiline)
                .Select(match => match.Groups[1].Value).Where(key => !key.StartsWith("m_"));
            Assert.That(keys, Is.EquivalentTo(FieldsOf<SimilarityStudySettings>().Concat(FieldsOf<StudySettings>())));
            Assert.That(KeysOfEntries("materials"), Is.EquivalentTo(FieldsOf<StudyMaterial>()));
            Assert.That(KeysOfEntries("methods"), Is.EquivalentTo(FieldsOf<StudyMethod>()));
        }

        [Test]
        public void TheSettingsAssetComparesTwoTiersOnSixMaterials()
        {
            string[] labels = Values("label").ToArray();
            Assert.That(labels, Is.EquivalentTo(new[] { "ceramic", "jute", "wood", "plastic", "fur", "metal" }));
            Assert.That(labels, Is.SubsetOf(DefaultModel.Asset().Header.Labels.Select(label => label.Name)));
            string model = File.ReadAllText(RepositoryFiles.In(
                "Packages", "com.haptoflow.runtime", "Runtime", "Models", "default.haptoflow.meta"));
            string guid = Regex.Match(model, "guid: (\\w{32})").Groups[1].Value;
            Assert.That(Regex.Matches(Asset, "model: .*" + guid), Has.Count.EqualTo(2));
            Assert.That(Values("quality"),
                Is.EqualTo(new[] { $"{(int)HapticQuality.Draft}", $"{(int)HapticQuality.Standard}" }));
            SimilarityStudySettings settings = Settings(
                Values("label").Select(label => new StudyMaterial(label, label)),
                new[] { new StudyMethod("a", DefaultModel.Asset(), HapticQuality.Draft),
                    new StudyMethod("b", DefaultModel.Asset(), HapticQuality.Standard) });
            Assert.That(settings.Check, Throws.Nothing);
        }

        [TestCase("SimilarityStudyScene.cs")]
        [TestCase("SimilarityStudySettings.asset")]
        public void TheSceneFileRefersToItsScriptAndItsSettings(string name)
        {
            string meta = File.ReadAllText(SampleFiles.In("SimilarityStudy", name + ".meta"));
            string guid = Regex.Match(meta, "guid: (\\w{32})").Groups[1].Value;
            Assert.That(File.ReadAllText(SampleFiles.In("SimilarityStudy", "SimilarityStudy.unity")), Does.Contain(guid));
        }

        [Test]
        public void TheScenesCameraSeesBothObjectsTheQuestionAndTheInstruction()
        {
            Begin(Settings(1, 2));
            scene.Panel.Open();
            IEnumerable<Vector3> places = FindAll<TextMesh>().Select(text => text.transform.position)
                .Concat(Enumerable.Range(0, 4).SelectMany(corner => new[]
                {
                    Corner(scene.Real.Frame, corner), Corner(scene.Virtual.Frame, corner),
                }));
            foreach (Vector3 place in places)
            {
                Vector3 pixels = scene.View!.WorldToScreenPoint(place);
                Assert.That(pixels.z, Is.GreaterThan(0f));
                Assert.That(pixels.x, Is.InRange(0f, scene.View.pixelWidth), $"{place}");
                Assert.That(pixels.y, Is.InRange(0f, scene.View.pixelHeight), $"{place}");
            }
        }

        private static IEnumerable<string> Values(string key) =>
            Regex.Matches(Asset, @"^    " + key + ": (.*)$", RegexOptions.Multiline)
                .Select(match => match.Groups[1].Value);

        private static IEnumerable<string> KeysOfEntries(string list)
        {
            string text = Regex.Match(
                Asset, $@"^  {list}:\n((?:  [- ] .*\n)+)", RegexOptions.Multiline).Groups[1].Value;
            return Regex.Matches(text, @"^  [- ] (\w+):", RegexOptions.Multiline)
                .Select(match => match.Groups[1].Value).Distinct();
        }

        private static IEnumerable<string> FieldsOf<T>() => typeof(T)
            .GetFields(BindingFlags.Instance | BindingFlags.NonPublic)
            .Where(field => field.GetCustomAttribute<SerializeField>() != null).Select(field => field.Name);
    }
}
