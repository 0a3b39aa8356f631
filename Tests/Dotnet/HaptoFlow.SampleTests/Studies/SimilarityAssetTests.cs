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

namespace HaptoFlow.SampleTests
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

        [TestCase("SimilarityStudyScene.cs")]
        [TestCase("SimilarityStudySettings.asset")]
        public void TheSceneFileRefersToItsScriptAndItsSettings(string name)
        {
            string meta = File.ReadAllText(SampleFiles.In("SimilarityStudy", name + ".meta"));
            string guid = Regex.Match(meta, "guid: (\\w{32})").Groups[1].Value;
            Assert.That(File.ReadAllText(SampleFiles.In("SimilarityStudy", "SimilarityStudy.unity")), Does.Contain(guid));
        }

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
