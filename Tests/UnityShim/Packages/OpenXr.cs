using System;
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEngine.InputSystem;
using UnityEngine.InputSystem.Controls;
using UnityEngine.InputSystem.Layouts;
using UnityEngine.XR.OpenXR.Features;
using UnityShim;

namespace UnityEngine.XR.OpenXR.Input
{
    /// <summary>Part of Unity's OpenXR package.</summary>
    public static class OpenXRInput
    {
        internal static ulong Handle;

        internal static List<(double Seconds, float Amplitude, float FrequencyHz, float Duration)> Impulses { get; } =
            new List<(double, float, float, float)>();

        internal static int Stops { get; private set; }

        public static ulong GetActionHandle(InputAction inputAction, InputSystem.InputDevice? inputDevice = null) => Handle;

        public static void SendHapticImpulse(InputAction action, float amplitude, float frequency, float duration,
            InputSystem.InputDevice? inputDevice = null) =>
            Impulses.Add((Clock.UnscaledSeconds, amplitude, frequency, duration));

        public static void StopHaptics(InputAction inputAction, InputSystem.InputDevice? inputDevice = null) => ++Stops;

        internal static void Reset()
        {
            Handle = 0uL;
            Impulses.Clear();
            Stops = 0;
        }
    }

    public struct Haptic
    {
    }

    public class HapticControl : InputControl<Haptic>
    {
        public HapticControl()
            : base(null)
        {
        }
    }

    public struct Pose
    {
    }

    public class PoseControl : InputControl<Pose>
    {
        public PoseControl()
            : base(null)
        {
        }

        [InputControl(offset = 0)]
        public ButtonControl isTracked { get; private set; } = null!;

        [InputControl(offset = 4)]
        public IntegerControl trackingState { get; private set; } = null!;

        [InputControl(offset = 8, noisy = true)]
        public Vector3Control position { get; private set; } = null!;

        [InputControl(offset = 20, noisy = true)]
        public QuaternionControl rotation { get; private set; } = null!;

        [InputControl(offset = 36, noisy = true)]
        public Vector3Control velocity { get; private set; } = null!;

        [InputControl(offset = 48, noisy = true)]
        public Vector3Control angularVelocity { get; private set; } = null!;
    }
}

namespace UnityEngine.XR.OpenXR
{
    public static class OpenXRRuntime
    {
        public static bool IsExtensionEnabled(string extensionName) => OpenXrRuntime.Extensions.Contains(extensionName);
    }

    public partial class OpenXRSettings : ScriptableObject
    {
        internal static Dictionary<BuildTargetGroup, OpenXRSettings> Groups { get; } =
            new Dictionary<BuildTargetGroup, OpenXRSettings>();

        internal List<OpenXRFeature> Features { get; } = new List<OpenXRFeature>();

        /// <summary>The settings of the running application; in the editor those of desktops.</summary>
        public static OpenXRSettings Instance =>
            GetSettingsForBuildTargetGroup(BuildTargetGroup.Standalone) ?? CreateInstance<OpenXRSettings>();

        /// <summary>Null until the project has settings of the plug-in.</summary>
        public static OpenXRSettings? GetSettingsForBuildTargetGroup(BuildTargetGroup buildTargetGroup) =>
            Groups.TryGetValue(buildTargetGroup, out OpenXRSettings? settings) ? settings : null;

        public TFeature? GetFeature<TFeature>()
            where TFeature : OpenXRFeature => Features.OfType<TFeature>().FirstOrDefault();

        public OpenXRFeature[] GetFeatures<TFeature>() => Features.Where(feature => feature is TFeature).ToArray();
    }
}

namespace UnityEngine.XR.OpenXR.Features
{
    [Serializable]
    public abstract partial class OpenXRFeature : ScriptableObject
    {
        [SerializeField]
        internal string openxrExtensionStrings = "";

        [SerializeField]
        private bool m_enabled;

        public bool enabled
        {
            get => m_enabled && !(OpenXrRuntime.IsRunning && HasFailed);
            set
            {
                m_enabled = value;
                OnEnabledChange();
            }
        }

        internal bool HasFailed { get; private set; }

        internal void Create() => HasFailed = !OnInstanceCreate(1uL);

        protected internal virtual bool OnInstanceCreate(ulong xrInstance) => true;

        protected internal virtual void OnEnabledChange()
        {
        }
    }

    [Serializable]
    public abstract class OpenXRInteractionFeature : OpenXRFeature
    {
        private static List<ActionMapConfig>? created;

        [Serializable]
        protected internal enum ActionType
        {
            Binary,
            Axis1D,
            Axis2D,
            Pose,
            Vibrate,
            Count,
        }

        protected virtual void RegisterDeviceLayout()
        {
        }

        protected virtual void UnregisterDeviceLayout()
        {
        }

        protected virtual void RegisterActionMapsWithRuntime()
        {
        }

        protected internal override bool OnInstanceCreate(ulong xrSession)
        {
            RegisterDeviceLayout();
            return true;
        }

        /// <summary>As until version 1.8: the editor knows the layout while a build target uses the feature.</summary>
        protected internal override void OnEnabledChange()
        {
            if (OpenXRSettings.Groups.Values.SelectMany(settings => settings.Features)
                .Any(feature => feature.enabled && feature.GetType() == GetType()))
            {
                RegisterDeviceLayout();
            }
            else
            {
                UnregisterDeviceLayout();
            }
        }

        protected virtual string GetDeviceLayoutName() => "";

        protected void AddActionMap(ActionMapConfig map) =>
            (created ?? throw new InvalidOperationException("ActionMap must be added from within the method")).Add(map);

        internal List<ActionMapConfig> CreateActionMaps()
        {
            created = new List<ActionMapConfig>();
            RegisterActionMapsWithRuntime();
            List<ActionMapConfig> maps = created;
            created = null;
            return maps;
        }

        public static class UserPaths
        {
            public const string leftHand = "/user/hand/left";
            public const string rightHand = "/user/hand/right";
        }

        [Serializable]
        protected internal class ActionBinding
        {
            public string? interactionProfileName;
            public string? interactionPath;
        }

        [Serializable]
        protected internal class ActionConfig
        {
            public string? name;
            public ActionType type;
            public string? localizedName;
            public List<ActionBinding>? bindings;
            public List<string>? usages;
        }

        protected internal class DeviceConfig
        {
            public InputDeviceCharacteristics characteristics;
            public string? userPath;
        }

        [Serializable]
        protected internal class ActionMapConfig
        {
            public string? name;
            public string? localizedName;
            public List<DeviceConfig>? deviceInfos;
            public List<ActionConfig>? actions;
            public string? desiredInteractionProfile;
            public string? manufacturer;
            public string? serialNumber;
        }
    }
}

namespace UnityEditor.XR.OpenXR.Features
{
    public class FeatureCategory
    {
        public const string Interaction = "Interaction";
    }

    [AttributeUsage(AttributeTargets.Class)]
    public class OpenXRFeatureAttribute : Attribute
    {
        public string? UiName;
        public string? Desc;
        public string? OpenxrExtensionStrings;
        public string? Company;
        public string? Version;
        public BuildTargetGroup[]? BuildTargetGroups;
        public string Category = "";
        public string FeatureId = "";
    }

    public static class FeatureHelpers
    {
        /// <summary>Makes the features of a build target that its settings lack.</summary>
        public static void RefreshFeatures(BuildTargetGroup group)
        {
            if (!UnityEngine.XR.OpenXR.OpenXRSettings.Groups.TryGetValue(group, out var settings))
            {
                settings = UnityEngine.ScriptableObject.CreateInstance<UnityEngine.XR.OpenXR.OpenXRSettings>();
                UnityEngine.XR.OpenXR.OpenXRSettings.Groups.Add(group, settings);
            }
            foreach (Type type in EditorTypes.All)
            {
                var about = (OpenXRFeatureAttribute?)Attribute.GetCustomAttribute(type, typeof(OpenXRFeatureAttribute));
                if (about == null || about.BuildTargetGroups?.Contains(group) == false ||
                    settings.Features.Any(feature => feature.GetType() == type))
                {
                    continue;
                }
                var made = (OpenXRFeature)UnityEngine.ScriptableObject.CreateInstance(type);
                made.openxrExtensionStrings = about.OpenxrExtensionStrings ?? "";
                settings.Features.Add(made);
            }
        }
    }
}

namespace UnityEngine.XR.Management
{
    /// <summary>Part of Unity's XR Plug-in Management: the settings of the platform that plays.</summary>
    public class XRGeneralSettings : ScriptableObject
    {
        public static XRGeneralSettings? Instance { get; set; }

        public XRManagerSettings? Manager { get; set; }
    }

    public sealed class XRManagerSettings : ScriptableObject
    {
        /// <summary>What was called, in order.</summary>
        internal List<string> Calls { get; } = new List<string>();

        /// <summary>The loader that finds a headset; null where none is connected.</summary>
        internal XRLoader? Working { get; set; }

        public XRLoader? activeLoader { get; internal set; }

        public void InitializeLoaderSync()
        {
            Calls.Add("initialize");
            activeLoader = Working;
        }

        public void StartSubsystems() => Calls.Add("start");

        public void StopSubsystems() => Calls.Add("stop");

        public void DeinitializeLoader()
        {
            StopSubsystems();
            Calls.Add("deinitialize");
            activeLoader = null;
        }
    }

    public abstract class XRLoader : ScriptableObject
    {
    }
}
