using System.Linq;
using HaptoFlow.Project;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.XR.Management;
using UnityShim;
using Object = UnityEngine.Object;

namespace HaptoFlow.SampleTests
{
    /// <summary>The scenes of the repository's Unity project, made from their files and played.</summary>
    public sealed class ProjectSceneTests : SampleTest
    {
        private ProjectScene scene = null!;

        [SetUp]
        public void LoadTheModel() => FinishLoading();

        [TearDown]
        public void CloseTheScene()
        {
            foreach (GameObject owner in scene.Owners.Where(each => each != null))
            {
                Object.DestroyImmediate(owner);
            }
        }

        [TestCase("Desk.unity")]
        [TestCase("Headset.unity")]
        public void TheBoardSaysWhatToDoWhereHaptoFlowDidNotLoadUntilItPlays(string name)
        {
            Open(name);
            Assert.That(Board(), Does.Contain("npm ci"));
            PlayFor(0.5);
            Assert.That(Board(), Does.Contain("draw over the plate"));
        }

        [Test]
        public void TheBoardSaysWhyThereAreNoHaptics()
        {
            HapticSession.ShutDown();
            HaptoFlowSettings.Active.Model = null;
            Open("Desk.unity");
            PlayFor(0.5);
            Assert.That(Board(), Does.Contain("no model is chosen"));
        }

        [Test]
        public void AStrokeOverTheDeskIsWoodAndIsHeard()
        {
            Open("Desk.unity");
            Draw(Vector3.zero, "wood");
        }

        [TestCase("Wood", "wood")]
        [TestCase("Jute", "jute")]
        [TestCase("Metal Mesh", "metal mesh")]
        [TestCase("Rubber", "rubber")]
        public void WithoutAHeadsetTheMouseFeelsEveryPlate(string name, string label)
        {
            Open("Headset.unity");
            Draw(TopOf(name), label);
        }

        [Test]
        public void MxInkFeelsThePlateTheMousePenGoesAndTheBoardFollowsThePenInTheHand()
        {
            Open("Headset.unity");
            MousePen mouse = All<MousePen>().Single();
            PlayFor(0.2);
            Assert.That(All<XrPen>().Select(pen => pen.Hand), Is.EquivalentTo(new[] { PenHand.Right, PenHand.Left }));
            Assert.That(mouse.isActiveAndEnabled, Is.True, "nothing is tracked");
            Track(TopOf("Jute") + 0.001f * Vector3.up);
            SimulatedInput.SetControl(Right + "tip", 0.4f);
            PlayFor(0.5);
            Assert.That(mouse.gameObject.activeSelf, Is.False);
            Assert.That(RightPen().IsTouching, Is.True);
            Assert.That(Board(), Does.StartWith("jute: ").And.EndWith("0.4 N"));
        }

        [Test]
        public void TheHeadStartsWhereTheSceneHasItsCameraAndThePlatesAreWithinReach()
        {
            Open("Headset.unity");
            Track(new Vector3(0.4f, 1.6f, 0.2f), "centerEyePosition", "<XRHMD>/");
            SimulatedInput.SetControl("<XRHMD>/centerEyeRotation", Quaternion.AngleAxis(70f, Vector3.up));
            Vector3 eyes = camera.transform.position;
            World.Frames(3);
            Assert.That(Vector3.Distance(camera.transform.position, eyes), Is.LessThan(1e-4f));
            foreach (HapticSurface plate in All<HapticSurface>())
            {
                Vector3 away = plate.transform.position - eyes;
                Assert.That(new Vector3(away.x, 0f, away.z).magnitude, Is.InRange(0.25f, 0.75f), plate.name);
                Assert.That(-away.y, Is.InRange(0.3f, 0.6f), plate.name);
            }
        }

        private void Open(string name)
        {
            scene = ProjectScene.Open(name);
            camera = All<Camera>().Single(each => each.gameObject.tag == "MainCamera");
        }

        /// <summary>A stroke of the mouse through a place feels like a label, is heard, and is on the board.</summary>
        private void Draw(Vector3 middle, string label)
        {
            HapticStylus stylus = All<MousePen>().Single().Stylus;
            Vector3 from = middle - 0.08f * Vector3.right;
            PointAt(from);
            PlayFor(0.3);
            Press(from, 0.2);
            AudioDevice.Forget();
            for (int frame = 0; frame < World.FrameRateHz; ++frame)
            {
                PointAt(from + 0.16f * frame / (float)World.FrameRateHz * Vector3.right);
                World.Frame();
                Assert.That(stylus.IsTouching, Is.True, $"frame {frame}");
            }
            Assert.That(stylus.Contact.Material!.Label, Is.EqualTo(label));
            Assert.That(Loudest(), Is.GreaterThan(Audible));
            Assert.That(Board(), Does.StartWith(label + ": "));
        }

        private static Vector3 TopOf(string name)
        {
            Transform plate = All<HapticSurface>().Single(each => each.name == name).transform;
            return plate.position + 0.5f * plate.localScale.y * Vector3.up;
        }

        private static string Board() => All<StatusBoard>().Single().Text;
    }

    /// <summary>The headset of the project's Headset scene, on computers.</summary>
    public sealed class StartHeadsetTests : SampleTest
    {
        private XRManagerSettings manager = null!;

        private sealed class Loader : XRLoader
        {
        }

        [SetUp]
        public void ConnectAHeadset()
        {
            World.Platform = RuntimePlatform.WindowsEditor;
            manager = ScriptableObject.CreateInstance<XRManagerSettings>();
            manager.Working = ScriptableObject.CreateInstance<Loader>();
            XRGeneralSettings.Instance = ScriptableObject.CreateInstance<XRGeneralSettings>();
            XRGeneralSettings.Instance.Manager = manager;
        }

        [TearDown]
        public void Disconnect()
        {
            World.Platform = RuntimePlatform.LinuxEditor;
            XRGeneralSettings.Instance = null;
        }

        [Test]
        public void TheHeadsetStartsWithTheSceneAndStopsWithIt()
        {
            GameObject owner = Start();
            Assert.That(manager.Calls, Is.EqualTo(new[] { "initialize", "start" }));
            Object.DestroyImmediate(owner);
            Assert.That(manager.Calls, Is.EqualTo(new[] { "initialize", "start", "stop", "deinitialize" }));
        }

        [Test]
        public void WithoutAHeadsetTheSceneGoesOnAndTheConsoleSaysSoOnce()
        {
            manager.Working = null;
            GameObject owner = Start();
            World.Frames(5);
            Assert.That(manager.Calls, Is.EqualTo(new[] { "initialize" }));
            Assert.That(Log.Lines, Has.Exactly(1).Matches<(LogType Type, string Text)>(line =>
                line.Type == LogType.Log && line.Text.StartsWith("HaptoFlow: no headset answered")));
            Object.DestroyImmediate(owner);
            Assert.That(manager.Calls, Is.EqualTo(new[] { "initialize" }), "what did not start is not stopped");
        }

        [Test]
        public void AHeadsetThatRunsAlreadyIsLeftAlone()
        {
            manager.InitializeLoaderSync();
            Object.DestroyImmediate(Start());
            Assert.That(manager.Calls, Is.EqualTo(new[] { "initialize" }));
        }

        [TestCase(RuntimePlatform.Android)]
        [TestCase(RuntimePlatform.LinuxEditor)]
        [TestCase(RuntimePlatform.OSXEditor)]
        public void ElsewhereNothingIsStarted(RuntimePlatform platform)
        {
            World.Platform = platform;
            Start();
            Assert.That(manager.Calls, Is.Empty);
        }

        [Test]
        public void WithoutXrSettingsNothingHappens()
        {
            XRGeneralSettings.Instance = null;
            ElsewhereNothingIsStarted(RuntimePlatform.WindowsEditor);
        }

        private GameObject Start()
        {
            GameObject owner = Make("Headset");
            owner.AddComponent<StartHeadset>();
            World.Frames(2);
            return owner;
        }
    }
}
