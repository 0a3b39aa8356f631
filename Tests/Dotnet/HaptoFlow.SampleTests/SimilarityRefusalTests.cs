using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text.RegularExpressions;
using System.Threading.Tasks;
using HaptoFlow.Model;
using HaptoFlow.Samples.SimilarityStudy;
using HaptoFlow.Studies;
using HaptoFlow.Tests;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    /// <summary>Problems that stop the study before it begins, and their messages.</summary>
    public sealed class SimilarityRefusalTests : SimilarityTest
    {
        private static string Asset => File.ReadAllText(SampleFiles.In("SimilarityStudy", "SimilarityStudySettings.asset"));

        private static IEnumerable<TestCaseData> Methods()
        {
            TestCaseData Case(string name, Func<StudyMethod> method, params string[] words) =>
                new TestCaseData(method, words).SetArgDisplayNames(name);
            yield return Case("damaged file", () => Method("DSTN", Named(EditedModel.Damaged(), "dstn-1"),
                HapticQuality.Standard), "method \"DSTN\"", "dstn-1.haptoflow", "checksum");
            yield return Case("no model", () => Method("SPSI", null, HapticQuality.Standard),
                "method \"SPSI\"", "has no model");
            yield return Case("Auto", () => Method("SPSI", DefaultModel.Asset(), HapticQuality.Auto),
                "method \"SPSI\"", "quality Auto");
            // The second is the quality of a settings asset of an earlier version.
            foreach (HapticQuality quality in new[] { HapticQuality.Standard, (HapticQuality)3 })
            {
                yield return Case("twice, " + quality, () => Method("Best", DefaultModel.Asset(), quality),
                    "\"Ours\" and \"Best\" are the same tier \"standard\"");
            }
            foreach (string name in new[] { "Ours", "", "a,b" })
            {
                yield return Case("name " + name, () => Method(name, EditedModel.OfAnotherSpace(),
                    HapticQuality.Standard), $"\"{name}\"");
            }
        }

        [TestCaseSource(nameof(Methods))]
        public void AMethodThatCannotBeComparedStopsTheStudy(Func<StudyMethod> method, string[] words)
        {
            SimilarityStudySettings settings = Settings(1, 3);
            settings.methods = settings.methods.Append(method()).ToArray();
            Refused(settings, words);
        }

        [TestCase("Hemp cloth", "hemp", "method \"Ours quick\" has no label \"hemp\"", "wood, plywood")]
        [TestCase("Void", " ", "material \"Void\"", "neither a label nor a Haptic Material")]
        public void AMaterialThatNoModelHasStopsTheStudy(string name, string label, params string[] words)
        {
            SimilarityStudySettings settings = Settings(1, 2);
            settings.materials = settings.materials.Append(new StudyMaterial { name = name, label = label }).ToArray();
            Refused(settings, words);
        }

        [Test]
        public void OnlyALearntMaterialOfAnotherModelStopsTheStudy()
        {
            HapticMaterial denim =
                HapticMaterial.Create(MaterialText.OfLabel(DefaultModel.Asset().File, "glass"), "cotton");
            SimilarityStudySettings settings = Settings(
                new[] { new StudyMaterial { name = "Denim", material = denim } }, Settings(1, 2).methods);
            Begin(settings);
            scene.Session!.Continue();
            TraceReal();
            AudioDevice.Forget();
            TraceVirtual();
            Assert.That(Haptics.LearntMaterials, Is.EqualTo(1));
            Assert.That(LoudestFelt(), Is.GreaterThan(Audible));
            Crash();
            Directory.Delete(folder, true);
            settings.methods = settings.methods.Append(
                Method("Foreign", EditedModel.OfAnotherSpace(), HapticQuality.Standard)).ToArray();
            Refused(settings, "material \"Denim\"", "method \"Foreign\"", "another model");
            UnityEngine.Object.DestroyImmediate(denim);
        }

        [Test]
        public void MissingSettingsMaterialsOrMethodsStopTheStudy()
        {
            Refused(Settings(0, 2), "materials: a study needs at least one");
            Crash();
            Refused(Settings(1, 0), "methods: a study needs at least one");
            Crash();
            Refused(null, "no settings are chosen");
        }

        [Test]
        public void AMethodSlowerThanTheEqualDelayStopsTheStudyAndIsNamed()
        {
            SimilarityStudySettings settings = Settings(1, 2);
            settings.equalDelayMilliseconds = 60f;
            inference = new Dictionary<string, double> { ["Rival quick"] = 80.0 };
            TryToBegin(settings);
            Assert.That(scene.Problem, Does.Contain("method \"Rival quick\" cannot have a delay of 60 ms"));
            Assert.That((scene.Session, Directory.Exists(folder)), Is.EqualTo(((StudySession?)null, false)));
        }

        [Test]
        public void AFailedMeasurementStopsTheStudyAndNamesTheMethod()
        {
            measure = (_, _) => Task.FromException<double>(new InvalidOperationException("no voice is free"));
            Open(Settings(1, 2));
            Prepare();
            Assert.That(scene.Problem,
                Does.Contain("method \"Ours quick\": its delay could not be measured: no voice"));
        }

        [Test]
        public void AResumedSessionKeepsItsDelay()
        {
            SimilarityStudySettings settings = Settings(1, 2);
            inference = new Dictionary<string, double> { ["Ours quick"] = 20.0 };
            Begin(settings);
            TakePart(3);
            double planned = scene.Delay!.Milliseconds;
            Crash();
            inference = new Dictionary<string, double> { ["Ours quick"] = 21.5 };
            Begin(settings);
            Assert.That(scene.Delay!.Milliseconds, Is.EqualTo(planned));
            TakePart();
            Assert.That(Rows().Select(row => Number(row, "delay_ms")), Is.All.EqualTo(planned));
            Assert.That(Rows().Where(row => row["method"] == "Ours quick").Select(row => row["system_delay_ms"])
                .Distinct().Count(), Is.EqualTo(2));
        }

        [Test]
        public void AnInterruptedSessionIsNotResumedWhenAMethodHasBecomeTooSlow()
        {
            SimilarityStudySettings settings = Settings(1, 2);
            Begin(settings);
            TakePart(3);
            byte[] before = File.ReadAllBytes(Csv);
            Crash();
            inference = new Dictionary<string, double> { ["Ours quick"] = 90.0 };
            TryToBegin(settings);
            Assert.That(scene.Problem, Does.Contain("method \"Ours quick\" cannot have a delay of"));
            Assert.That(File.ReadAllBytes(Csv), Is.EqualTo(before));
        }

        [TestCase(0.25f, 0f, "would overlap")]
        [TestCase(0.01f, 0.3f, "at least 0.02")]
        public void ObjectsThatCannotBeTracedStopTheStudy(float width, float aside, string expected)
        {
            SimilarityStudySettings settings = Settings(1, 2);
            settings.sampleMetres = new Vector3(width, 0.01f, 0.15f);
            settings.virtualMetres = new Vector3(aside, 0f, 0f);
            Refused(settings, expected);
        }

        [Test]
        public void WithoutUnitysAudioTheStudyIsRefusedWithTheReason()
        {
            AudioDevice.IsSwitchedOff = true;
            TryToBegin(Settings(1, 2));
            Assert.That(scene.Problem, Does.Contain("Disable Unity Audio"));
            Assert.That(scene.Session, Is.Null);
            Assert.That(Directory.Exists(folder), Is.False, "nothing was begun");
        }

        [Test]
        public void AFinishedParticipantIsRefusedAndAnotherCanBegin()
        {
            SimilarityStudySettings settings = Settings(1, 1);
            Begin(settings);
            TakePart();
            Crash();
            TryToBegin(settings);
            Assert.That(scene.Problem, Does.Contain("participant 7 has finished this study"));
            scene.Begin(8);
            Assert.That((scene.Problem, scene.Session!.Plan.Participant), Is.EqualTo(((string?)null, 8)));
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
        public void TheSettingsAssetContainsEveryFieldExactlyOnce()
        {
            IEnumerable<string> keys = Regex.Matches(Asset, @"^  ([a-z]\w*):", RegexOptions.Multiline)
                .Select(match => match.Groups[1].Value).Where(key => !key.StartsWith("m_"));
            Assert.That(keys, Is.EquivalentTo(NamesOf<SimilarityStudySettings>().Concat(NamesOf<StudySettings>())));
            Assert.That(KeysOfEntries("materials"), Is.EquivalentTo(NamesOf<StudyMaterial>()));
            Assert.That(KeysOfEntries("methods"), Is.EquivalentTo(NamesOf<StudyMethod>()));
        }

        private static IEnumerable<string> NamesOf<T>() => FieldsOf<T>().Select(field => field.Name);

        private static IEnumerable<string> KeysOfEntries(string list)
        {
            string text = Regex.Match(
                Asset, $@"^  {list}:\n((?:  [- ] .*\n)+)", RegexOptions.Multiline).Groups[1].Value;
            return Regex.Matches(text, @"^  [- ] (\w+):", RegexOptions.Multiline)
                .Select(match => match.Groups[1].Value).Distinct();
        }

        private void Refused(SimilarityStudySettings? settings, params string[] words)
        {
            Open(settings);
            Prepare();
            Assert.That(scene.Problem, Is.Not.Null);
            foreach (string word in words)
            {
                Assert.That(scene.Problem, Does.Contain(word));
            }
            scene.Begin(7);
            PlayFor(0.5);
            Assert.That(scene.Session, Is.Null);
            Assert.That(scene.Operator.Lines, Has.Some.StartsWith("STOPPED: "));
            Assert.That(Directory.Exists(folder), Is.False, "nothing was begun");
        }
    }
}
