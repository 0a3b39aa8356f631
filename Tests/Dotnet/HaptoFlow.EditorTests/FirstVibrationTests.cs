using System;
using System.Linq;
using HaptoFlow.Editor;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

namespace HaptoFlow.EditorTests
{
    /// <summary>The clicks of the page getting-started.md, and what plays then.</summary>
    public sealed class FirstVibrationTests : PlayedTest
    {
        private const float Audible = 0.001f;

        private string drawnIn = "Right";
        private Camera camera = null!;
        private ProjectScene? opened;

        /// <summary>Loads the optional assemblies, which .NET loads on first use only, unlike Unity.</summary>
        [OneTimeSetUp]
        public void LoadOptionalAssemblies() => OptionalAssemblies.Load();

        [SetUp]
        public void OpenANewScene()
        {
            camera = MainCamera();
            drawnIn = "Right";
            Undo.IncrementCurrentGroup();
        }

        [TearDown]
        public void LeaveTheScene()
        {
            StopPlaying();
            foreach (GameObject each in opened?.Owners.Where(each => each != null) ?? Enumerable.Empty<GameObject>())
            {
                Object.DestroyImmediate(each);
            }
            opened = null;
        }

        [TestCase(true)]
        [TestCase(false)]
        public void TheDeskOfACloneAndAFirstSceneSoundOnTheLoudspeakers(bool isClone)
        {
            if (isClone)
            {
                Object.DestroyImmediate(camera.gameObject);
                opened = ProjectScene.Open("Desk.unity");
                camera = Camera.main!;
            }
            else
            {
                MakeFirstScene();
            }
            EditorSession.Play();
            PressOverThePlate();
            Assert.That(Peak(0), Is.GreaterThan(Audible));
            Assert.That(Peak(1), Is.GreaterThan(Audible));
        }

        [Test]
        public void AChannelMakesTheRightChannelAloneVibrate()
        {
            MakeFirstScene();
            EditorScreen.Enter("Channel", 1);
            InspectorTests.Draw(All<HapticOutput>().Single());
            EditorSession.Play();
            PressOverThePlate();
            Assert.That(Peak(1), Is.GreaterThan(Audible));
            Assert.That(Peak(0), Is.Zero);
        }

        [TestCase("Right")]
        [TestCase("Left")]
        public void AHeadsetsControllerVibratesAlone(string hand)
        {
            drawnIn = hand;
            PlayWithAHeadset();
            OVRInput.Controller wanted = hand == "Left" ? OVRInput.Controller.LTouch : OVRInput.Controller.RTouch;
            Assert.That(OVRInput.Waves.Count(wave => wave.Mask == wanted), Is.GreaterThan(20));
            Assert.That(OVRInput.Waves.Select(wave => wave.Mask), Is.All.EqualTo(wanted));
            Assert.That(Peak(0), Is.Zero, "the Haptic Output of First Scene is left to loudspeakers");
            Assert.That(BuildCheck.Findings(BuildTarget.StandaloneLinux64).Select(finding => finding.Text),
                Has.None.Contains("settings"));
        }

        [Test]
        public void MxInkVibrates()
        {
            OVRPlugin.Take(OVRPlugin.Hand.HandRight, OVRPlugin.MxInkProfile);
            PlayWithAHeadset();
            Assert.That(OVRPlugin.Pulses.Count, Is.GreaterThan(20));
            Assert.That(Peak(0), Is.Zero);
        }

        [TestCase(false)]
        [TestCase(true)]
        public void APenAddedLaterIsFeltInTheHandAndWithAnAutoOutputHeardToo(bool withAutoOutput)
        {
            AddAPenLater();
            if (withAutoOutput)
            {
                All<XrPen>().Single().Stylus!.gameObject.AddComponent<AutoOutput>();
            }
            EditorSession.Play();
            DrawWithDevices();
            Assert.That(OVRInput.Waves.Count, Is.GreaterThan(20));
            Assert.That(Peak(0) > Audible, Is.EqualTo(withAutoOutput));
            if (!withAutoOutput)
            {
                Assert.That(Log.Lines.Select(line => line.Text), Has.Exactly(1).Matches<string>(text =>
                    text.Contains("XR Pen Right is felt through") && text.Contains("Choose a channel on Haptic Output")));
                SetTracked("Right", false);
                PressOverThePlate();
                Assert.That(Peak(0), Is.GreaterThan(Audible), "the mouse");
            }
        }

        private static void MakeFirstScene() => CreateMenu.CreateFirstScene(new MenuCommand(null));

        private void AddAPenLater()
        {
            MakeFirstScene();
            AddRig();
            CreateMenu.CreateRightPen(new MenuCommand(null));
        }

        /// <summary>Play mode takes the place of the headset's build.</summary>
        private void PlayWithAHeadset()
        {
            AddRig();
            MakeFirstScene();
            CheckSceneWindow.Open();
            EditorScreen.Press("Create Settings");
            EditorScreen.Draw(EditorWindow.GetWindow<CheckSceneWindow>().OnGUI);
            EditorSession.Play();
            DrawWithDevices();
        }

        /// <summary>Adds what the rig of a headset consists of, and a controller in each hand.</summary>
        private void AddRig()
        {
            GameObject rig = Make("Rig");
            rig.AddComponent<OVRCameraRig>();
            camera.transform.SetParent(Make("Tracking Space", rig).transform, false);
            OVRPlugin.Connected = OVRPlugin.Controller.LTouch | OVRPlugin.Controller.RTouch;
            SetTracked("Left", false);
            SetTracked("Right", false);
        }

        private void PressOverThePlate()
        {
            Transform plate = Begin();
            SimulatedInput.MouseButton = true;
            Frames(90, frame => SimulatedInput.MousePosition = camera.WorldToScreenPoint(Top(plate, frame)));
            SimulatedInput.MouseButton = false;
        }

        private void DrawWithDevices()
        {
            Transform plate = Begin();
            SetTracked(drawnIn, true);
            SimulatedInput.SetControl($"<XRController>{{{drawnIn}Hand}}/pointerRotation", Quaternion.identity);
            Frames(90, frame => SimulatedInput.SetControl(
                $"<XRController>{{{drawnIn}Hand}}/pointerPosition", Top(plate, frame) + 0.001f * Vector3.up));
        }

        private static void SetTracked(string hand, bool isTracked) =>
            SimulatedInput.SetControl($"<XRController>{{{hand}Hand}}/isTracked", isTracked ? 1f : 0f);

        private static Transform Begin()
        {
            HapticSession.Current.FinishLoading();
            AudioDevice.Forget();
            OVRInput.Waves.Clear();
            OVRPlugin.Pulses.Clear();
            return All<HapticSurface>().Single().transform;
        }

        /// <summary>A point on the plate that moves at up to 0.3 m/s.</summary>
        private static Vector3 Top(Transform plate, int frame) => plate.position + new Vector3(
            0.05f * (float)Math.Sin(6.0 * frame / World.FrameRateHz), 0.5f * plate.lossyScale.y, 0f);

        private static float Peak(int channel) => Enumerable.Range(0, AudioDevice.RecordedFrames)
            .Max(frame => Math.Abs(AudioDevice.Sample(frame, channel)));

        /// <summary>Stands for the component of that name in Meta's SDK.</summary>
        private sealed class OVRCameraRig : MonoBehaviour
        {
        }
    }
}
