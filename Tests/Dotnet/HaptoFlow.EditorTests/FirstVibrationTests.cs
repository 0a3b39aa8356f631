using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Reflection;
using System.Text.RegularExpressions;
using HaptoFlow.Editor;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

namespace HaptoFlow.EditorTests
{
    /// <summary>Walks the tables of the page first-vibration.md click by click, adds the clicks up, and checks what
    /// plays then.</summary>
    public sealed class FirstVibrationTests : EditorTest
    {
        private const string Clone = "From a clone, with mouse and loudspeakers";
        private const string Desktop = "A desktop, with mouse and loudspeakers";
        private const string Headset = "A Quest 3, with controllers or MX Ink";
        private const string Coil = "A voice coil behind an amplifier, on the right audio channel";
        private const string Later = "A pen added later";
        private const string Both = "What plays where";
        private const float Audible = 0.001f;
        private static readonly string[] Page =
            File.ReadAllLines(RepositoryFiles.In("Documentation~", "first-vibration.md"));

        private readonly HashSet<string> drawnIn = new HashSet<string>();
        private Camera camera = null!;
        private ProjectScene? opened;
        private Object? inspected;

        /// <summary>Loads the optional assemblies, which .NET loads on first use only, unlike Unity.</summary>
        [OneTimeSetUp]
        public void LoadOptionalAssemblies() => OptionalAssemblies.Load();

        [SetUp]
        public void OpenANewScene()
        {
            HapticSession.OptionsOverride = new HapticEngineOptions { WithoutWorker = true, FixedLeadMs = 8.0, Seed = 3 };
            HeldDevices.Reset();
            SimulatedInput.Reset();
            GameObject owner = Make("Main Camera");
            owner.tag = "MainCamera";
            owner.transform.position = new Vector3(0f, 1f, -10f);
            camera = owner.AddComponent<Camera>();
            owner.AddComponent<AudioListener>();
            Undo.IncrementCurrentGroup();
            drawnIn.Clear();
            drawnIn.Add("Right");
        }

        [TearDown]
        public void LeaveTheScene()
        {
            if (Application.isPlaying)
            {
                EditorSession.Stop();
            }
            foreach (GameObject each in opened?.Owners.Where(each => each != null) ?? Enumerable.Empty<GameObject>())
            {
                Object.DestroyImmediate(each);
            }
            opened = null;
            HapticSession.OptionsOverride = null;
            HeldDevices.Reset();
            SimulatedInput.Reset();
        }

        [Test]
        public void TheClonesClicksMakeTheLoudspeakersSound()
        {
            Walk(Clone);
            Assert.That(Peak(0), Is.GreaterThan(Audible));
            Assert.That(Peak(1), Is.GreaterThan(Audible));
        }

        [Test]
        public void TheDesktopsClicksMakeTheLoudspeakersSound()
        {
            Walk(Desktop);
            Assert.That(Peak(0), Is.GreaterThan(Audible));
            Assert.That(Peak(1), Is.GreaterThan(Audible));
        }

        [Test]
        public void TheHeadsetsClicksMakeAControllerVibrate([Values("Right", "Left")] string hand)
        {
            AddRig();
            drawnIn.Clear();
            drawnIn.Add(hand);
            Walk(Headset);
            OVRInput.Controller wanted = hand == "Left" ? OVRInput.Controller.LTouch : OVRInput.Controller.RTouch;
            Assert.That(OVRInput.Waves.Count(wave => wave.Mask == wanted), Is.GreaterThan(20));
            Assert.That(OVRInput.Waves.Select(wave => wave.Mask), Is.All.EqualTo(wanted));
            Assert.That(Peak(0), Is.Zero, "the Haptic Output of First Scene is left to loudspeakers");
            Assert.That(BuildCheck.Findings(BuildTarget.StandaloneLinux64).Select(finding => finding.Text),
                Has.None.Contains("settings"));
        }

        [Test]
        public void TheHeadsetsClicksMakeMxInkVibrate()
        {
            AddRig();
            OVRPlugin.Take(OVRPlugin.Hand.HandRight, OVRPlugin.MxInkProfile);
            Walk(Headset);
            Assert.That(OVRPlugin.Pulses.Count, Is.GreaterThan(20));
            Assert.That(Peak(0), Is.Zero);
        }

        [Test]
        public void TheCoilsClicksMakeTheRightChannelAloneVibrate()
        {
            Walk(Coil);
            Assert.That(Peak(1), Is.GreaterThan(Audible));
            Assert.That(Peak(0), Is.Zero);
        }

        [Test]
        public void APenAddedAfterFirstSceneIsFeltInTheHandAndTheMouseIsHeard()
        {
            Perform(Rows(Desktop)[0].What);
            AddRig();
            Walk(Later);
            Assert.That(OVRInput.Waves.Count, Is.GreaterThan(20));
            Assert.That(Peak(0), Is.Zero);
            Assert.That(Log.Lines.Select(line => line.Text), Has.Exactly(1).Matches<string>(text =>
                text.Contains("XR Pen Right is felt through") && text.Contains("Choose a channel on Haptic Output")));
            SetTracked("Right", false);
            PressOverThePlate();
            Assert.That(Peak(0), Is.GreaterThan(Audible));
        }

        [Test]
        public void APenInTheHandIsHeardTooAfterTheClicksForIt()
        {
            Perform(Rows(Desktop)[0].What);
            AddRig();
            Perform(Rows(Later)[0].What);
            Walk(Both);
            EditorSession.Play();
            DrawWithDevices();
            Assert.That(OVRInput.Waves.Count, Is.GreaterThan(20));
            Assert.That(Peak(0), Is.GreaterThan(Audible));
        }

        [Test]
        public void CheckSceneSaysWhatPlaysEachStylusBeforePlaying()
        {
            Settings();
            MxInkSwitch.SwitchOn();
            Perform(Rows(Desktop)[0].What);
            AddRig();
            Perform(Rows(Later)[0].What);
            Assert.That(StylusPlaces.Summary(new SceneContents()).Split('\n'), Is.EquivalentTo(new[]
            {
                "Mouse Pen plays on Haptic Output (all channels of the audio device).",
                "XR Pen Right is felt through the device in the right hand; until one is connected it plays on Haptic " +
                    "Output (all channels of the audio device).",
            }));
            Assert.That(SceneCheck.Run().Select(finding => finding.Text).Where(text => !text.Contains("DSP Buffer")),
                Is.Empty);
        }

        private void Walk(string section)
        {
            foreach ((string what, int clicks) in Rows(section)[..^1])
            {
                Assert.That(Perform(what), Is.EqualTo(clicks), what);
            }
        }

        /// <summary>The rows of the last table of a section.</summary>
        private static (string What, int Clicks)[] Rows(string section)
        {
            string[] lines = Page.SkipWhile(line => line != "## " + section).Skip(1)
                .TakeWhile(line => !line.StartsWith("## ")).ToArray();
            Assert.That(lines, Is.Not.Empty, section);
            return lines.Select(line => Regex.Match(line, "^\\| (.+) \\| ([0-9]+) \\|$")).Where(match => match.Success)
                .Select(match => (match.Groups[1].Value, int.Parse(match.Groups[2].Value))).ToArray();
        }

        /// <summary>Does what a row says; returns the number of clicks.</summary>
        private int Perform(string row)
        {
            string[] bold = Regex.Matches(row, "\\*\\*([^*]+)\\*\\*").Select(match => match.Groups[1].Value).ToArray();
            if (row.StartsWith("*Unity:*"))
            {
                // The stand-in has no players: play mode takes the place of the headset's build.
                EditorSession.Play();
                return bold[0].Split(" > ").Length;
            }
            switch (row)
            {
                case "**Play**":
                    EditorSession.Play();
                    return 1;
                case string hold when hold.StartsWith("hold the left mouse button over the plate and draw"):
                    PressOverThePlate();
                    return 1;
                case "draw over the plate with a controller or MX Ink":
                    DrawWithDevices();
                    return 0;
                case string add when add.StartsWith("**Add Component > "):
                    return AddComponent(bold[0].Split(" > "));
                case string menu when menu.StartsWith("**"):
                    return Choose(bold[0]);
                case string button when button.StartsWith("in Check Scene: "):
                    EditorScreen.Press(bold[0]);
                    EditorScreen.Draw(EditorWindow.GetWindow<CheckSceneWindow>().OnGUI);
                    return 1;
                case string scene when scene.StartsWith("in the Project window: double-click "):
                    OpenScene(bold[0]);
                    return 2;
                case string place when place.StartsWith("in the Hierarchy: "):
                    return Select(bold);
                case string field when field.StartsWith("in the Inspector: "):
                    EditorScreen.Enter(bold[0], int.Parse(row.Split(' ')[^1]));
                    InspectorTests.Draw(((GameObject)inspected!).GetComponent<HapticOutput>());
                    return 1;
                default:
                    throw new AssertionException("nobody knows how to do: " + row);
            }
        }

        private static int Choose(string path)
        {
            MethodInfo entry = typeof(CreateMenu).Assembly.GetTypes()
                .SelectMany(type => type.GetMethods(BindingFlags.Static | BindingFlags.NonPublic | BindingFlags.Public))
                .Single(method => method.GetCustomAttributes<MenuItem>()
                    .Any(item => !item.validate && item.menuItem == path.Replace(" > ", "/")));
            entry.Invoke(null, entry.GetParameters().Length == 0 ? null : new object[] { new MenuCommand(null) });
            return path.Split(" > ").Length;
        }

        /// <summary>Opens a scene of this repository's project; the objects of the scene before it go.</summary>
        private void OpenScene(string name)
        {
            Object.DestroyImmediate(camera.gameObject);
            opened = ProjectScene.Open(name + ".unity");
            camera = Camera.main!;
        }

        /// <summary>Selects an object, below objects that have to be unfolded with a click each.</summary>
        private int Select(string[] names)
        {
            Transform chosen = All<Transform>().Single(each => each.name == names[0] &&
                (names.Length == 1 ? each.parent == null : each.parent != null && each.parent.name == names[1]));
            inspected = chosen.gameObject;
            Selection.activeObject = inspected;
            return names.Length;
        }

        private int AddComponent(string[] path)
        {
            Type type = typeof(HapticOutput).Assembly.GetTypes().Single(each =>
                each.GetCustomAttribute<AddComponentMenu>()?.componentMenu == string.Join("/", path.Skip(1)));
            typeof(GameObject).GetMethods().Single(method => method.Name == "AddComponent" && method.IsGenericMethod)
                .MakeGenericMethod(type).Invoke(inspected, null);
            return path.Length;
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
            Begin();
            Transform plate = All<HapticSurface>().Single().transform;
            SimulatedInput.MouseButton = true;
            SteppedFrames.Play(90, frame => SimulatedInput.MousePosition = camera.WorldToScreenPoint(Top(plate, frame)));
            SimulatedInput.MouseButton = false;
        }

        private void DrawWithDevices()
        {
            Begin();
            Transform plate = All<HapticSurface>().Single().transform;
            SteppedFrames.Play(90, frame =>
            {
                foreach (string hand in drawnIn)
                {
                    SetTracked(hand, true);
                    SimulatedInput.SetControl($"<XRController>{{{hand}Hand}}/pointerPosition",
                        Top(plate, frame) + 0.001f * Vector3.up);
                    SimulatedInput.SetControl($"<XRController>{{{hand}Hand}}/pointerRotation", Quaternion.identity);
                }
            });
        }

        private static void SetTracked(string hand, bool isTracked) =>
            SimulatedInput.SetControl($"<XRController>{{{hand}Hand}}/isTracked", isTracked ? 1f : 0f);

        private static void Begin()
        {
            HapticSession.Current.FinishLoading();
            AudioDevice.Forget();
            OVRInput.Waves.Clear();
            OVRPlugin.Pulses.Clear();
        }

        /// <summary>A point on the plate that moves at up to 0.3 m/s.</summary>
        private static Vector3 Top(Transform plate, int frame) => plate.position + new Vector3(
            0.05f * (float)Math.Sin(6.0 * frame / World.FrameRateHz), 0.5f * plate.lossyScale.y, 0f);

        private static float Peak(int channel) => Enumerable.Range(0, AudioDevice.RecordedFrames)
            .Max(frame => Math.Abs(AudioDevice.Sample(frame, channel)));

        private static T[] All<T>()
            where T : Object => Object.FindObjectsByType<T>(FindObjectsInactive.Include, FindObjectsSortMode.None);

        /// <summary>Stands for the component of that name in Meta's SDK.</summary>
        private sealed class OVRCameraRig : MonoBehaviour
        {
        }
    }
}
