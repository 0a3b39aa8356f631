using System;
using System.IO;
using System.Linq;
using System.Text.RegularExpressions;
using HaptoFlow.ProjectCheck;
using HaptoFlow.Tests;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;
using UnityEngine.XR;
using UnityShim;

namespace HaptoFlow.ShimTests
{
    /// <summary>Repeated play mode with domain reload off, which keeps static fields, and loading of scenes.</summary>
    public sealed class PlayModeTests : SceneTest
    {
        [Test]
        public void EveryPlayModeStartsAndEndsItsOwnEngine()
        {
            for (int round = 0; round < 3; ++round)
            {
                FinishLoading();
                HapticEngine engine = HapticSession.Current.Engine!;
                HapticStylus stylus = Touch();
                Assert.That(stylus.IsTouching, Is.True);
                Assert.That(engine.Statistics().Voices, Is.EqualTo(1u));
                World.ExitPlayMode();
                Assert.That(HapticSession.Existing, Is.Null);
                Assert.Throws<HaptoFlowException>(() => engine.Statistics());
                World.EnterPlayMode();
                HaptoFlowSettings settings = ScriptableObject.CreateInstance<HaptoFlowSettings>();
                settings.Model = DefaultModel.Asset();
                settings.Quality = HapticQuality.Draft;
                HaptoFlowSettings.Active = settings;
            }
        }

        [Test]
        public void MapsCollidersAndSurfacesOfThePreviousPlayModeAreNotUsed()
        {
            FinishLoading();
            HapticMaterialMap map = ScriptableObject.CreateInstance<HapticMaterialMap>();
            HapticMaterial wood = ScriptableObject.CreateInstance<HapticMaterial>();
            map.DefaultMaterial = wood;
            Make("Scope").AddComponent<HapticMaterialMapScope>().Map = map;
            Make("Plank").AddComponent<BoxCollider>();
            HapticStylus stylus = StylusAlong(_ => Vector3.zero);
            HapticSurface board = Board();
            board.transform.position = 5f * Vector3.right;
            World.Frames(2);
            Assert.That(stylus.IsTouching, Is.True);
            Assert.That(MappedColliders.Count, Is.EqualTo(1));
            Assert.That(SurfaceRegistry.Holds(board.GetComponent<Collider>(), board), Is.True);
            // Play mode ends abnormally: the objects are gone without any message to the scripts.
            World.EnterPlayMode();
            Assert.That(MaterialMaps.Any, Is.False);
            Assert.That(MappedColliders.Count, Is.Zero);
            Assert.That(SurfaceRegistry.Holds(board.GetComponent<Collider>(), board), Is.False);
        }

        [Test]
        public void ASceneLoadKeepsTheEngineAndFreesTheVoice()
        {
            FinishLoading();
            Touch();
            HapticEngine engine = HapticSession.Current.Engine!;
            World.LoadEmptyScene();
            Assert.That(HapticSession.Current.Engine, Is.SameAs(engine));
            Assert.That(engine.Statistics().Voices, Is.Zero);
            HapticStylus next = Touch();
            Assert.That(next.IsTouching, Is.True);
            Assert.That(engine.Statistics().Voices, Is.EqualTo(1u));
        }

        [Test]
        public void SettingsInAResourcesFolderAreFound()
        {
            HaptoFlowSettings settings = ScriptableObject.CreateInstance<HaptoFlowSettings>();
            settings.Ceiling = 0.125f;
            World.ExitPlayMode();
            World.EnterPlayMode();
            World.AddResource("HaptoFlowSettings", settings);
            Assert.That(HaptoFlowSettings.Active, Is.SameAs(settings));
        }

        [Test]
        public void NoSampleExceedsTheCeiling()
        {
            HaptoFlowSettings.Active.Ceiling = 0.01f;
            FinishLoading();
            Board("sandpaper");
            AudioTap tap = Output(out _);
            StylusAlong(seconds => new Vector3(0.15f * (float)System.Math.Sin(6.0 * seconds), 0.0005f, 0f));
            World.Frames(180);
            Assert.That(tap.Peak(), Is.LessThanOrEqualTo(0.01f).And.GreaterThan(0.005f));
        }

        private HapticStylus Touch()
        {
            Board();
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0.05f * (float)seconds, 0.001f, 0f));
            World.Frames(10);
            return stylus;
        }
    }

    /// <summary>The engine's update rate, which follows the display.</summary>
    public sealed class DisplayRateTests : SceneTest
    {
        [SetUp]
        [TearDown]
        public void RemoveTheHeadset() => Displays.Reset();

        [TestCase(60u, 1u, new[] { 120f }, true, 120.0, TestName = "a headset before the screen")]
        [TestCase(59940u, 1000u, new[] { float.NaN }, true, 59.94, TestName = "the screen beside a headset without a rate")]
        [TestCase(0u, 1u, new float[0], true, 80.0, TestName = "the settings without a display's rate")]
        [TestCase(0u, 1u, new[] { 120f }, false, 80.0, TestName = "the settings where the display is not followed")]
        [TestCase(0u, 1u, new[] { 0f, -1f, float.PositiveInfinity, 1e6f }, true, 80.0, TestName = "no implausible rate")]
        public void TheEngineRunsAtTheRateOf(uint screen, uint share, float[] headsets, bool follows, double expectedHz)
        {
            Displays.Screen = new RefreshRate { numerator = screen, denominator = share };
            Array.ForEach(headsets, hertz => Displays.Wear(float.IsNaN(hertz) ? (float?)null : hertz));
            Displays.Wear(90f).Stop();
            (HaptoFlowSettings.Active.UpdateRateHz, HaptoFlowSettings.Active.FollowDisplay) = (80f, follows);
            FinishLoading();
            Assert.That(Haptics.Problem, Is.Null);
            Haptics.TryGetStatistics(out EngineStatistics engine);
            double rateHz = 1000.0 * HaptoFlowSettings.Active.BudgetShare / engine.BudgetMs;
            Assert.That(rateHz, Is.EqualTo(expectedHz).Within(1e-3));
        }
    }

    public sealed class RuntimeIsInstalledTests : SceneTest
    {
        [Test]
        public void AfterNpmCiTheConsoleIsSilent()
        {
            RuntimeIsInstalled.Check(RepositoryFiles.Root);
            Assert.That(Errors(), Is.Empty);
        }

        [Test]
        public void WithoutItTheConsoleNamesTheCommandAndTheFolder()
        {
            string clone = Path.Combine(Path.GetTempPath(), $"haptoflow-clone-{Guid.NewGuid():N}");
            LogAssert.Expect(LogType.Error, new Regex("\"npm ci\" in "));
            RuntimeIsInstalled.Check(clone);
            Assert.That(Errors().Single(), Does.Contain(clone).And.Contain("open the project again"));
        }

        private static string[] Errors() =>
            Log.Lines.Where(line => line.Type == LogType.Error).Select(line => line.Text).ToArray();
    }
}
