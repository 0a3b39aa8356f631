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
