using System;
using System.IO;
using System.Linq;
using HaptoFlow.Samples.ClipSet;
using HaptoFlow.Tests;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.MissingLibraryTests
{
    /// <summary>The sample Clip Set, without the native library.</summary>
    public sealed class ClipSetTests : SceneTest
    {
        private static readonly string Folder = RepositoryFiles.In("Samples~", "ClipSet");
        private static readonly string Index = File.ReadAllText(Path.Combine(Folder, "index.json"));

        private ClipSetPlayer player = null!;
        private HapticSurface board = null!;
        private float speedMps;

        [SetUp]
        public void SlideOverABoard()
        {
            board = Board();
            double way = 0.0;
            StylusAlong(seconds =>
            {
                way += speedMps / World.FrameRateHz;
                return new Vector3(0.1f * (float)Math.Sin(10.0 * way), 0.001f, 0f);
            });
            player = Begin(Index, true);
        }

        [Test]
        public void AStylusIsHeardWithoutTheLibrary()
        {
            speedMps = 0.12f;
            World.Frames(60);
            Assert.That(Haptics.Problem, Does.Contain("native library"));
            Assert.That(Playing(), Is.EqualTo(new[] { "wood_300mmps_1N", "wood_50mmps_1N" }));
            board.Material.Label = "sandpaper";
            World.Frames(20);
            Assert.That(Playing(), Is.EqualTo(new[] { "sandpaper_300mmps_1N", "sandpaper_50mmps_1N" }));
            speedMps = 0f;
            World.Frames(60);
            Assert.That(Playing(), Is.Empty, "at rest");
        }

        [Test]
        public void ALabelThatTheSetLacksIsSaidOnceAndSilent()
        {
            board.Material.Label = "fur";
            speedMps = 0.12f;
            World.Frames(60);
            Assert.That(Playing(), Is.Empty);
            Assert.That(Log.Count("the set has no clips of fur"), Is.EqualTo(1));
        }

        [Test]
        public void ADisabledPlayerLeavesNoSources()
        {
            speedMps = 0.12f;
            World.Frames(60);
            player.enabled = false;
            World.Frames(2);
            Assert.That(Sources(), Is.Empty);
            player.enabled = true;
            World.Frames(20);
            Assert.That(Playing(), Has.Length.EqualTo(2));
        }

        [TestCase("{}", "format")]
        [TestCase("[", "line")]
        [TestCase("{\"format\":\"haptoflow clip set\",\"version\":2}", "version")]
        public void AnIndexThatIsNoneIsSaid(string text, string reason)
        {
            player.enabled = false;
            Begin(text, false);
            World.Frames(3);
            Assert.That(Log.Count("is not the index of a clip set"), Is.EqualTo(1));
            Assert.That(Log.Lines.Last(line => line.Text.Contains("is not the index")).Text, Does.Contain(reason));
        }

        [Test]
        public void ThePrefabNamesEveryFileOfTheSet()
        {
            string prefab = File.ReadAllText(Path.Combine(Folder, "Clip Set.prefab"));
            foreach (string file in Directory.GetFiles(Folder, "*.wav").Append(Path.Combine(Folder, "index.json")))
            {
                string meta = File.ReadAllText(file + ".meta");
                string guid = System.Text.RegularExpressions.Regex.Match(meta, "guid: (\\w+)").Groups[1].Value;
                Assert.That(prefab, Does.Contain(guid), file);
            }
            var set = new ClipSetIndex(Index);
            foreach (string label in new[] { "wood", "sandpaper" })
            {
                Assert.That(File.Exists(Path.Combine(Folder, set.NameOf(label, 1, 0) + ".wav")), Is.True);
            }
        }

        [TestCase(0.05, 1.0, 0.0, 0.0)]
        [TestCase(0.1, 0.70710678, 0.70710678, 0.0)]
        [TestCase(0.2, 0.0, 1.0, 0.0)]
        [TestCase(0.8, 0.0, 0.0, 1.0)]
        [TestCase(5.0, 0.0, 0.0, 1.0)]
        [TestCase(0.01, 0.2, 0.0, 0.0)]
        [TestCase(0.0, 0.0, 0.0, 0.0)]
        [TestCase(double.NaN, 0.0, 0.0, 0.0)]
        public void GainsFollowTheRuleOfTheIndex(double speed, double first, double second, double third)
        {
            double[] speeds = { 0.05, 0.2, 0.8 };
            double[] forces = { 1.0 };
            var at = new ClipBlend(speeds, speed);
            Assert.That(Enumerable.Range(0, 3).Select(
                    index => (double)ClipBlend.Gain(at, index, new ClipBlend(forces, 3.0), 0)),
                Is.EqualTo(new[] { first, second, third }).Within(1e-6));
            Assert.That(ClipBlend.Gain(at, 0, new ClipBlend(forces, 0.5), 0), Is.EqualTo(0.5 * first).Within(1e-6));
        }

        private ClipSetPlayer Begin(string text, bool withClips)
        {
            var made = Make("Clip Set").AddComponent<ClipSetPlayer>();
            made.Use(Keep(new TextAsset(text)), withClips
                ? Directory.GetFiles(Folder, "*.wav").Select(file => Keep(AudioClip.Create(
                    Path.GetFileNameWithoutExtension(file), 48000, 1, 48000, false))).ToArray()
                : Array.Empty<AudioClip>());
            return made;
        }

        private AudioSource[] Sources() => All<AudioSource>().Where(each => each.clip != null).ToArray();

        private string[] Playing() => Sources().Where(each => each.isPlaying && each.volume > 0f)
            .Select(each => each.clip!.name).OrderBy(name => name, StringComparer.Ordinal).ToArray();
    }
}
