using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using NUnit.Framework;
using UnityEditor;
using UnityEditor.XR.OpenXR.Features;
using UnityEngine;
using UnityEngine.InputSystem;
using UnityEngine.InputSystem.Layouts;
using UnityEngine.Scripting;
using UnityEngine.XR.OpenXR;
using UnityEngine.XR.OpenXR.Features;
using UnityEngine.XR.OpenXR.Input;
using UnityShim;

namespace HaptoFlow.ShimTests
{
    /// <summary>MX Ink through Meta's SDK: with Logitech's action set, and as the Touch controller that it is without.
    /// </summary>
    public sealed class MxInkTests : HeldDeviceTest
    {
        private static readonly Vector3 OnTheBoard = new Vector3(0.05f, 0.0015f, 0.08f);

        [Test]
        public void AnXrPenFollowsThePenAndReadsItsForceWithoutAnyScript()
        {
            XrPen pen = HeldPen(PenHand.Right);
            OVRPlugin.Tip = 0.4f;
            World.Frames(72);
            Assert.That(Vector3.Distance(pen.transform.localPosition, OnTheBoard), Is.LessThan(1e-6f));
            Assert.That(pen.Stylus!.isActiveAndEnabled, Is.True);
            Assert.That(pen.Stylus.Hand, Is.EqualTo(HapticHand.Right));
            Assert.That(pen.Stylus.Contact.ForceNewtons, Is.EqualTo(0.4f).Within(1e-5f));
            Assert.That(Log.Count("", LogType.Warning), Is.Zero);
        }

        [Test]
        public void AnXrPenIsFeltInThePensOwnMotor([Values] PenHand hand)
        {
            XrPen pen = HeldPen(hand);
            OVRPlugin.Tip = 0.4f;
            for (int frame = 0; frame < 144; ++frame)
            {
                float x = 0.05f * (float)Math.Cos(0.06 * frame);
                float z = 0.05f * (float)Math.Sin(0.06 * frame);
                Move(hand, new Vector3(x, 0.001f, z), new Quaternion(0f, 0f, 0f, 1f));
                World.Frame();
            }
            Assert.That(pen.Stylus!.IsTouching, Is.True);
            OVRPlugin.Hand expected = hand == PenHand.Left ? OVRPlugin.Hand.HandLeft : OVRPlugin.Hand.HandRight;
            Assert.That(OVRPlugin.Pulses.Count, Is.GreaterThan(60));
            Assert.That(OVRPlugin.Pulses.Select(pulse => pulse.Hand), Is.All.EqualTo(expected));
        }

        [Test]
        public void ThePensFrameIsTurnedIntoUnitys()
        {
            XrPen pen = HeldPen(PenHand.Right);
            // A quarter turn about y to the left in a right-handed frame points along -x in both.
            Move(PenHand.Right, Vector3.zero, new Quaternion(0f, (float)Math.Sqrt(0.5), 0f, (float)Math.Sqrt(0.5)));
            World.Frames(2);
            Vector3 pointing = pen.transform.localRotation * Vector3.forward;
            Assert.That(Vector3.Distance(pointing, new Vector3(-1f, 0f, 0f)), Is.LessThan(1e-5f));
        }

        [Test]
        public void APenThatIsPutAwayEndsTheTouchAndAnotherDeviceTakesOver()
        {
            XrPen pen = HeldPen(PenHand.Right);
            World.Frames(72);
            Assert.That(pen.Stylus!.IsTouching, Is.True);
            OVRPlugin.Take(OVRPlugin.Hand.HandRight, OVRPlugin.TouchPlusProfile);
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            World.Frames(144);
            Assert.That(pen.Stylus.isActiveAndEnabled, Is.False);
            PointAbove();
            World.Frames(2);
            Assert.That(pen.Stylus.isActiveAndEnabled, Is.True);
            Assert.That(pen.transform.localPosition.y, Is.EqualTo(0.2f).Within(1e-6f));
        }

        [Test]
        public void AnActionSetWithoutThePoseIsNamedOnceWithItsRemedy()
        {
            HeldPen(PenHand.Right);
            OVRPlugin.Poses.Clear();
            World.Frames(72 * 20);
            Assert.That(Log.Count("no action \"aim_right\"", LogType.Warning), Is.EqualTo(1));
            Assert.That(Log.Count("logitech.github.io/mxink", LogType.Warning), Is.EqualTo(1));
            Assert.That(OVRPlugin.FailedPoses, Is.InRange(2, 5), "each logs an error of the SDK");
        }

        [Test]
        public void AnActionSetWithoutTheForceLeavesThePoseAndTheSpringModel()
        {
            XrPen pen = HeldPen(PenHand.Right);
            World.Frames(72 * 10);
            Assert.That(pen.Stylus!.IsTouching, Is.True);
            Assert.That(pen.Stylus.Contact.ForceNewtons, Is.GreaterThan(0f));
            Assert.That(OVRPlugin.Calls, Is.InRange(1, 4));
            Assert.That(Log.Count("no action \"tip\"", LogType.Warning), Is.EqualTo(1));
        }

        [Test]
        public void TheForceOfMetasActionSaysInWhichHandThePenIs()
        {
            OVRPlugin.Take(OVRPlugin.Hand.HandLeft, OVRPlugin.MxInkProfile);
            OVRPlugin.Tip = 0.4f;
            Pen.Hand = HapticHand.None;
            Pen.Force = Pen.gameObject.AddComponent<MetaActionTipForce>();
            World.Frames(72);
            Assert.That(Pen.Hand, Is.EqualTo(HapticHand.Left));
            Assert.That(OVRPlugin.Pulses.Count, Is.GreaterThan(60));
            Assert.That(OVRPlugin.Pulses.Select(pulse => pulse.Hand), Is.All.EqualTo(OVRPlugin.Hand.HandLeft));
            OVRPlugin.Take(OVRPlugin.Hand.HandLeft, OVRPlugin.TouchPlusProfile);
            World.Frames(300);
            Assert.That(Pen.Hand, Is.EqualTo(HapticHand.Left), "the pen sleeps");
            OVRPlugin.Take(OVRPlugin.Hand.HandRight, OVRPlugin.MxInkProfile);
            World.Frames(300);
            Assert.That(Pen.Hand, Is.EqualTo(HapticHand.Right), "the user has changed the hand");
            Assert.That(OVRPlugin.Pulses[^1].Hand, Is.EqualTo(OVRPlugin.Hand.HandRight));
        }

        [Test]
        public void AStylusGivenToAnXrPenLaterGetsItsHand()
        {
            XrPen pen = XrPen.Create(null, PenHand.Left);
            Pen.Hand = HapticHand.None;
            pen.Stylus = Pen;
            Assert.That(Pen.Hand, Is.EqualTo(HapticHand.Left));
            pen.Hand = PenHand.Right;
            Assert.That(Pen.Hand, Is.EqualTo(HapticHand.Right));
            UnityEngine.Object.DestroyImmediate(pen.gameObject);
        }

        [Test]
        public void APenWithoutItsActionSetIsRecognisedAndPlaysOnItsMotor()
        {
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            OVRPlugin.Take(OVRPlugin.Hand.HandRight, OVRPlugin.TouchProfile);
            XrHand.Right.Take("Oculus Touch Controller - Right", true);
            // The force of the tip is on the stick's x axis, 1 in the air.
            OVRPlugin.MoveRightStick(1f, 0f, false);
            World.Frames(72);
            OVRInput.Waves.Clear();
            OVRPlugin.MoveRightStick(0.4f, 0f, false);
            World.Frames(72);
            Assert.That(OVRInput.Waves, Is.Empty, "nobody says that the pen plays waveforms");
            Assert.That(XrHand.Right.Impulses.Count, Is.GreaterThan(60));
            Assert.That(Log.Count("behaves like an MX Ink", LogType.Warning), Is.EqualTo(1));
            Assert.That(Log.Count("logitech.github.io/mxink", LogType.Warning), Is.EqualTo(1));
        }

        [Test]
        public void AnXrPenRecognisesAPenWithoutItsProfile()
        {
            Pen.enabled = false;
            GameObject owner = XrPen.Create(null, PenHand.Right).gameObject;
            PointAbove();
            SimulatedInput.SetControl("<XRController>{RightHand}/thumbstick", new Vector2(1f, 0f));
            SimulatedInput.SetControl("<XRController>{RightHand}/thumbstickTouched", 0f);
            World.Frames(72);
            Assert.That(Log.Count("behaves like an MX Ink", LogType.Warning), Is.EqualTo(1));
            UnityEngine.Object.DestroyImmediate(owner);
        }

        [Test]
        public void AStickIsAStick([Values("under a thumb", "at rest", "for a moment", "upwards")] string how)
        {
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            for (int frame = 0; frame < 144; ++frame)
            {
                bool moment = frame / 20 % 2 == 0;
                OVRPlugin.MoveRightStick(how == "at rest" || (how == "for a moment" && moment) ? 0f : 1f,
                    how == "upwards" ? 0.7f : 0f, how == "under a thumb");
                World.Frame();
            }
            Assert.That(OVRInput.Waves.Count, Is.GreaterThan(120));
            Assert.That(Log.Count("MX Ink", LogType.Warning), Is.Zero);
        }

        private static void PointAbove()
        {
            SimulatedInput.SetControl("<XRController>{RightHand}/isTracked", 1f);
            SimulatedInput.SetControl("<XRController>{RightHand}/pointerPosition", new Vector3(0f, 0.2f, 0f));
            SimulatedInput.SetControl("<XRController>{RightHand}/pointerRotation", Quaternion.identity);
        }

        private XrPen HeldPen(PenHand hand)
        {
            Pen.enabled = false;
            OVRPlugin.Hand held = hand == PenHand.Left ? OVRPlugin.Hand.HandLeft : OVRPlugin.Hand.HandRight;
            OVRPlugin.Take(held, OVRPlugin.MxInkProfile);
            Move(hand, OnTheBoard, new Quaternion(0f, 0f, 0f, 1f));
            return XrPen.Create(Make("Tracking Space").transform, hand);
        }

        /// <summary>Moves the pen as Meta's runtime reports it: in a right-handed frame.</summary>
        /// <param name="unity">The position in Unity's frame.</param>
        /// <param name="rightHanded">The orientation in the runtime's frame.</param>
        private static void Move(PenHand hand, Vector3 unity, Quaternion rightHanded) =>
            OVRPlugin.Poses[hand == PenHand.Left ? "aim_left" : "aim_right"] = new OVRPlugin.Posef
            {
                Position = new OVRPlugin.Vector3f { x = unity.x, y = unity.y, z = -unity.z },
                Orientation = new OVRPlugin.Quatf
                {
                    x = rightHanded.x, y = rightHanded.y, z = rightHanded.z, w = rightHanded.w,
                },
            };
    }

    /// <summary>MX Ink through Unity's OpenXR plug-in by the package's own profile.</summary>
    public sealed class MxInkProfileTests : HeldDeviceTest
    {
        private const string Left = OpenXRInteractionFeature.UserPaths.leftHand;
        private const string Right = OpenXRInteractionFeature.UserPaths.rightHand;
        private static readonly Vector3 OnTheBoard = new Vector3(0.05f, 0.0015f, 0.08f);

        // The components of the profile in the specification of XR_LOGITECH_mx_ink_stylus_interaction, revision 1.
        private static readonly string[] Specified =
        {
            "/input/system/click", "/input/grip/pose", "/input/aim/pose", "/input/cluster_front_logitech/click",
            "/input/cluster_front_logitech/double_tap_logitech", "/input/cluster_middle_logitech/force",
            "/input/cluster_back_logitech/click", "/input/cluster_back_logitech/double_tap_logitech",
            "/input/dock_logitech/docked_logitech", "/input/tip_logitech/force", "/input/tip_logitech/pose",
            "/output/haptic",
        };

        [TestCase(PenHand.Right, Right)]
        [TestCase(PenHand.Left, Left)]
        public void AnXrPenOfASceneWithoutARigFollowsTheTipAndItsForceAndIsFelt(PenHand hand, string userPath)
        {
            Pen.enabled = false;
            OpenXrDevice held = Take(userPath);
            XrPen pen = Make("XR Rig").AddComponent<XrRig>().AddPen(hand);
            held.Set("/input/tip_logitech/force", 0.4f);
            held.Move("/input/grip/pose", new Vector3(0f, 0.1f, 0f), Quaternion.identity);
            for (int frame = 0; frame < 144; ++frame)
            {
                float x = 0.05f * (float)Math.Cos(0.06 * frame);
                float z = 0.05f * (float)Math.Sin(0.06 * frame);
                held.Move("/input/tip_logitech/pose", new Vector3(x, 0.001f, z), Quaternion.identity);
                World.Frame();
                Assert.That(Vector3.Distance(pen.transform.localPosition, new Vector3(x, 0.001f, z)), Is.LessThan(1e-6f));
            }
            Assert.That(pen.Stylus!.Contact.ForceNewtons, Is.EqualTo(0.4f).Within(1e-5f));
            Assert.That(OpenXRInput.Impulses.Count, Is.GreaterThan(60));
            Assert.That(Log.Count("", LogType.Warning), Is.Zero);
            held.Move("/input/grip/pose", Vector3.zero, Quaternion.identity, isTracked: false);
            World.Frames(2);
            Assert.That(pen.Stylus.isActiveAndEnabled, Is.False);
        }

        [TestCase("/input/tip_logitech/force", "tip")]
        [TestCase("/input/cluster_middle_logitech/force", "clusterMiddleButton")]
        [TestCase("/input/cluster_front_logitech/click", "clusterFrontButton")]
        [TestCase("/input/cluster_front_logitech/double_tap_logitech", "clusterFrontDoubleTap")]
        [TestCase("/input/cluster_back_logitech/click", "clusterBackButton")]
        [TestCase("/input/cluster_back_logitech/double_tap_logitech", "clusterBackDoubleTap")]
        [TestCase("/input/system/click", "systemButton")]
        [TestCase("/input/dock_logitech/docked_logitech", "docked")]
        public void AComponentArrivesAtTheControlThatOtherPackagesNameAlike(string path, string control)
        {
            OpenXrDevice held = Take(Right);
            string[] controls = Actions().Select(action => action.name!).ToArray();
            held.Set(path, 0.75f);
            Assert.That(Read<float>(Right, control), Is.EqualTo(0.75f));
            Assert.That(controls.Where(each => Read<float>(Right, each) != 0f), Is.EqualTo(new[] { control }));
        }

        [Test]
        public void PosesArriveAtTheirControlsAndAtThoseOfEveryController()
        {
            OpenXrDevice held = Take(Left);
            var turn = new Quaternion(0f, 1f, 0f, 0f);
            held.Move("/input/grip/pose", new Vector3(1f, 0f, 0f), turn);
            held.Move("/input/aim/pose", new Vector3(2f, 0f, 0f), turn);
            held.Move("/input/tip_logitech/pose", new Vector3(3f, 0f, 0f), turn);
            string[] positions =
                { "devicePose/position", "devicePosition", "pointer/position", "pointerPosition", "tipPose/position" };
            Assert.That(positions.Select(each => Read<Vector3>(Left, each).x), Is.EqualTo(new[] { 1f, 1f, 2f, 2f, 3f }));
            string[] rotations =
                { "devicePose/rotation", "deviceRotation", "pointer/rotation", "pointerRotation", "tipPose/rotation" };
            Assert.That(rotations.Select(each => Read<Quaternion>(Left, each).y), Is.All.EqualTo(1f));
            Assert.That(Read<float>(Left, "isTracked"), Is.EqualTo(1f));
            Assert.That(Read<int>(Left, "trackingState"), Is.EqualTo(3));
        }

        [Test]
        public void EveryComponentOfTheSpecificationIsBoundOnceInBothHandsAndNoOther()
        {
            SwitchOn<MxInkInteraction>();
            OpenXrRuntime.Start(MxInkFeatures.Extension);
            Assert.That(Actions().SelectMany(action => action.bindings!).Select(binding => binding.interactionPath),
                Is.EquivalentTo(Specified));
            Assert.That(Actions().SelectMany(action => action.bindings!)
                .Select(binding => binding.interactionProfileName).Distinct(),
                Is.EqualTo(new[] { "/interaction_profiles/logitech/mx_ink_stylus_logitech" }));
            Assert.That(OpenXrRuntime.Maps.Single().deviceInfos!.Select(device => device.userPath),
                Is.EquivalentTo(new[] { Left, Right }));
            Assert.That(Actions().Select(action => action.localizedName), Is.Unique);
            Assert.That(Actions().Select(action => action.name!.ToLowerInvariant()), Is.Unique);
        }

        [Test]
        public void TheDeviceHasAllItsControlsWithTheUsagesOfTheActions()
        {
            var pen = (MxInkStylus)Take(Right).Device;
            Assert.That(UnityEngine.InputSystem.XR.XRController.rightHand, Is.SameAs(pen));
            foreach (PropertyInfo property in OwnControls())
            {
                Assert.That(property.GetValue(pen), Is.InstanceOf(property.PropertyType), property.Name);
                Assert.That(property.IsDefined(typeof(PreserveAttribute), false), property.Name + " survives stripping");
            }
            Dictionary<string, string?> usages = OwnControls().ToDictionary(property => property.Name,
                property => property.GetCustomAttribute<InputControlAttribute>()!.usage);
            foreach (OpenXRInteractionFeature.ActionConfig action in Actions())
            {
                Assert.That(action.usages, Is.EqualTo(usages[action.name!] is { } usage
                    ? new[] { usage } : Array.Empty<string>()), action.name);
            }
            Assert.That(typeof(MxInkStylus).GetCustomAttribute<InputControlLayoutAttribute>()!.commonUsages,
                Is.EqualTo(new[] { "LeftHand", "RightHand" }));
        }

        [Test]
        public void ItsDeviceIsNotTakenForThatOfAnotherPackage()
        {
            SwitchOn<MxInkInteraction>();
            OpenXrRuntime.Start(MxInkFeatures.Extension);
            (Type type, InputDeviceMatcher own) = InputSystem.Layouts[LayoutName()];
            string product = OpenXrRuntime.Maps.Single().localizedName!;
            Assert.That(type, Is.EqualTo(typeof(MxInkStylus)));
            Assert.That(own.Matches("XRInputV1", product), Is.True);
            Assert.That(own.Matches("XRInput", product), Is.True, "the older interface");
            Assert.That(own.Matches("HID", product), Is.False);
            // The device of Logitech's own feature.
            Assert.That(own.Matches("XRInputV1", "Logitech MX Ink Stylus"), Is.False);
            InputDeviceMatcher others = new InputDeviceMatcher().WithProduct("Logitech MX Ink Stylus");
            Assert.That(others.Matches("XRInputV1", product), Is.False);
        }

        [Test]
        public void TheEditorKnowsTheLayoutWhileTheFeatureIsOn()
        {
            MxInkInteraction feature = SwitchOn<MxInkInteraction>();
            Assert.That(InputSystem.Layouts.Keys, Is.EqualTo(new[] { LayoutName() }));
            feature.enabled = false;
            Assert.That(InputSystem.Layouts, Is.Empty);
        }

        [Test]
        public void ItStaysOffWhereAnotherFeatureBringsTheProfileAndSaysSoOnce()
        {
            SwitchOn<MxInkInteraction>();
            SwitchOn<ForeignProfile>();
            OpenXrRuntime.Start(MxInkFeatures.Extension);
            Assert.That(OpenXrRuntime.Maps.Select(map => map.localizedName), Is.EqualTo(new[] { "Foreign pen" }));
            OpenXrRuntime.Start(MxInkFeatures.Extension);
            Assert.That(Log.Count("MX Ink Stylus (HaptoFlow) stays off, because ForeignProfile", LogType.Log),
                Is.EqualTo(1));
        }

        [Test]
        public void AForeignFeatureThatIsOffOrOfAnotherDeviceChangesNothing()
        {
            SwitchOn<MxInkInteraction>();
            SwitchOn<OtherDevice>();
            SwitchOn<ForeignProfile>().enabled = false;
            OpenXrRuntime.Start(MxInkFeatures.Extension);
            Assert.That(OpenXrRuntime.Maps.Select(map => map.localizedName),
                Is.EquivalentTo(new[] { "MX Ink Stylus HaptoFlow", "Other device" }));
            Assert.That(Log.Count("stays off", LogType.Log), Is.Zero);
        }

        [Test]
        public void AHeadsetWithoutTheExtensionGetsNoActionsForIt()
        {
            SwitchOn<MxInkInteraction>();
            OpenXrRuntime.Start();
            Assert.That(OpenXrRuntime.Maps, Is.Empty);
            Assert.That(Log.Lines, Is.Empty);
        }

        private static OpenXrDevice Take(string userPath)
        {
            SwitchOn<MxInkInteraction>();
            OpenXrRuntime.Start(MxInkFeatures.Extension);
            OpenXrDevice held = OpenXrRuntime.Take(MxInkInteraction.Profile, userPath);
            held.Move("/input/tip_logitech/pose", OnTheBoard, Quaternion.identity);
            return held;
        }

        private static TFeature SwitchOn<TFeature>()
            where TFeature : OpenXRFeature
        {
            FeatureHelpers.RefreshFeatures(BuildTargetGroup.Standalone);
            TFeature feature = OpenXRSettings.Instance.GetFeature<TFeature>()!;
            feature.enabled = true;
            return feature;
        }

        private static List<OpenXRInteractionFeature.ActionConfig> Actions() => OpenXrRuntime.Maps.Single().actions!;

        private static TValue Read<TValue>(string userPath, string control)
            where TValue : struct
        {
            using var action = new InputAction(binding:
                (userPath == Left ? "<XRController>{LeftHand}/" : "<XRController>{RightHand}/") + control);
            action.Enable();
            return action.ReadValue<TValue>();
        }

        private static PropertyInfo[] OwnControls() => typeof(MxInkStylus)
            .GetProperties(BindingFlags.Instance | BindingFlags.Public | BindingFlags.DeclaredOnly);

        private static string LayoutName() => (string)typeof(MxInkInteraction)
            .GetMethod("GetDeviceLayoutName", BindingFlags.Instance | BindingFlags.NonPublic)!
            .Invoke(OpenXRSettings.Instance.GetFeature<MxInkInteraction>(), null)!;

        [OpenXRFeature(OpenxrExtensionStrings = "XR_EXT_other " + MxInkFeatures.Extension)]
        private sealed class ForeignProfile : OpenXRInteractionFeature
        {
            protected override void RegisterActionMapsWithRuntime() => AddActionMap(new ActionMapConfig
            {
                localizedName = "Foreign pen", desiredInteractionProfile = MxInkInteraction.Profile,
            });
        }

        [OpenXRFeature(OpenxrExtensionStrings = "XR_EXT_other")]
        private sealed class OtherDevice : OpenXRInteractionFeature
        {
            protected override void RegisterActionMapsWithRuntime() =>
                AddActionMap(new ActionMapConfig { localizedName = "Other device" });
        }
    }
}
