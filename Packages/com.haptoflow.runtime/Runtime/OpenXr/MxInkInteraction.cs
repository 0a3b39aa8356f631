#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEngine;
using UnityEngine.InputSystem;
using UnityEngine.InputSystem.Layouts;
using UnityEngine.InputSystem.XR;
using UnityEngine.XR;
using UnityEngine.XR.OpenXR;
using UnityEngine.XR.OpenXR.Features;
#if UNITY_EDITOR
using UnityEditor;
using UnityEditor.XR.OpenXR.Features;
#endif

namespace HaptoFlow
{
    /// <summary>The interaction profile of MX Ink for Unity's OpenXR plug-in, by the published extension
    /// XR_LOGITECH_mx_ink_stylus_interaction. It adds the device <see cref="MxInkStylus"/> to the Input System.</summary>
    /// <remarks>Switch it on under Project Settings > XR Plug-in Management > OpenXR, for each build target. It stays off
    /// where a feature of another package brings the same profile.</remarks>
#if UNITY_EDITOR
    [OpenXRFeature(
        UiName = DisplayName,
        BuildTargetGroups = new[] { BuildTargetGroup.Standalone, BuildTargetGroup.Android },
        Company = "HaptoFlow",
        Desc = "Gives an MX Ink the force and the pose of its tip, its buttons and its motor.",
        OpenxrExtensionStrings = MxInkFeatures.Extension,
        Version = "1.0.0",
        Category = FeatureCategory.Interaction,
        FeatureId = Id)]
#endif
    public sealed class MxInkInteraction : OpenXRInteractionFeature
    {
        /// <summary>The feature's name in Project Settings.</summary>
        public const string DisplayName = "MX Ink Stylus (HaptoFlow)";

        /// <summary>The feature's identifier in Unity's OpenXR plug-in.</summary>
        public const string Id = "com.haptoflow.input.mxink";

        /// <summary>The profile's path in OpenXR.</summary>
        public const string Profile = "/interaction_profiles/logitech/mx_ink_stylus_logitech";

        // Layouts and devices of other packages have other names: in the editor the layouts of all features are
        // registered, also of those that are switched off.
        private const string Layout = nameof(MxInkStylus);
        private const string Product = "MX Ink Stylus HaptoFlow";

        private static bool hasSaid;

        /// <inheritdoc/>
        protected override bool OnInstanceCreate(ulong xrInstance)
        {
            OpenXRFeature? other = MxInkFeatures.SwitchedOn(OpenXRSettings.Instance)
                .FirstOrDefault(feature => !(feature is MxInkInteraction));
            if (other != null)
            {
                Say(other);
                return false;
            }
            return OpenXRRuntime.IsExtensionEnabled(MxInkFeatures.Extension) && base.OnInstanceCreate(xrInstance);
        }

        /// <inheritdoc/>
        protected override void RegisterDeviceLayout() => InputSystem.RegisterLayout(typeof(MxInkStylus), Layout,
            new InputDeviceMatcher()
                .WithInterface(XRUtilities.InterfaceMatchAnyVersion)
                .WithProduct(Product, supportRegex: false));

        /// <inheritdoc/>
        protected override void UnregisterDeviceLayout() => InputSystem.RemoveLayout(Layout);

#if HAPTOFLOW_OPENXR_1_9
        /// <inheritdoc/>
        protected override string GetDeviceLayoutName() => Layout;
#endif

        /// <inheritdoc/>
        protected override void RegisterActionMapsWithRuntime() => AddActionMap(new ActionMapConfig
        {
            name = "haptoflowmxink",
            localizedName = Product,
            desiredInteractionProfile = Profile,
            manufacturer = "Logitech",
            serialNumber = "",
            deviceInfos = new List<DeviceConfig>
            {
                Device(UserPaths.leftHand, InputDeviceCharacteristics.Left),
                Device(UserPaths.rightHand, InputDeviceCharacteristics.Right),
            },
            actions = new List<ActionConfig>
            {
                // These two first: controls of MxInkStylus count on their place.
                Action("devicePose", "Grip Pose", ActionType.Pose, "/input/grip/pose", "Device"),
                Action("pointer", "Aim Pose", ActionType.Pose, "/input/aim/pose", "Pointer"),
                Action("tipPose", "Tip Pose", ActionType.Pose, "/input/tip_logitech/pose", "TipPose"),
                Action("tip", "Tip Force", ActionType.Axis1D, "/input/tip_logitech/force", "Tip"),
                Action("clusterMiddleButton", "Middle Button Force", ActionType.Axis1D,
                    "/input/cluster_middle_logitech/force", "Trigger"),
                Action("clusterFrontButton", "Front Button", ActionType.Binary,
                    "/input/cluster_front_logitech/click", "GripButton"),
                Action("clusterFrontDoubleTap", "Front Button Double Tap", ActionType.Binary,
                    "/input/cluster_front_logitech/double_tap_logitech"),
                Action("clusterBackButton", "Back Button", ActionType.Binary,
                    "/input/cluster_back_logitech/click", "PrimaryButton"),
                Action("clusterBackDoubleTap", "Back Button Double Tap", ActionType.Binary,
                    "/input/cluster_back_logitech/double_tap_logitech", "SecondaryButton"),
                Action("systemButton", "System Button", ActionType.Binary, "/input/system/click", "MenuButton"),
                Action("docked", "Docked", ActionType.Binary, "/input/dock_logitech/docked_logitech"),
                Action("haptic", "Haptic Output", ActionType.Vibrate, "/output/haptic", "Haptic"),
            },
        });

        private static DeviceConfig Device(string userPath, InputDeviceCharacteristics hand) => new DeviceConfig
        {
            userPath = userPath,
            characteristics = InputDeviceCharacteristics.HeldInHand | InputDeviceCharacteristics.TrackedDevice |
                InputDeviceCharacteristics.Controller | hand,
        };

        /// <param name="control">The control of <see cref="MxInkStylus"/> that shows the action.</param>
        /// <param name="usages">The usages by which <see cref="InputDevices"/> finds the action.</param>
        private static ActionConfig Action(
            string control, string localizedName, ActionType type, string path, params string[] usages) => new ActionConfig
            {
                name = control,
                localizedName = localizedName,
                type = type,
                usages = usages.ToList(),
                bindings = new List<ActionBinding>
            {
                new ActionBinding { interactionPath = path, interactionProfileName = Profile },
            },
            };

        private static void Say(OpenXRFeature other)
        {
            if (!hasSaid)
            {
                hasSaid = true;
                Debug.Log($"HaptoFlow: {DisplayName} stays off, because {other.GetType().Name} brings the profile of MX Ink " +
                    "too, and OpenXR takes one of them only. Both are under Project Settings > XR Plug-in Management > " +
                    "OpenXR; switch one off.");
            }
        }

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Forget() => hasSaid = false;
    }

    /// <summary>The OpenXR features that bring an interaction profile of MX Ink, from whichever package.</summary>
    internal static class MxInkFeatures
    {
        public const string Extension = "XR_LOGITECH_mx_ink_stylus_interaction";

        /// <summary>Those that are switched on for a build target.</summary>
        public static IEnumerable<OpenXRFeature> SwitchedOn(OpenXRSettings settings) => settings
            .GetFeatures<OpenXRInteractionFeature>()
            .Where(feature => feature.enabled && Requests(feature));

        // Unity's plug-in stores the extensions that a feature requests in a field that it does not publish.
        private static bool Requests(OpenXRFeature feature) => JsonUtility.ToJson(feature).Contains(Extension);
    }
}
