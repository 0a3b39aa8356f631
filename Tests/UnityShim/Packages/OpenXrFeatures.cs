using System;
using System.Collections.Generic;
using System.Linq;
using UnityShim;

namespace UnityEngine.XR.OpenXR
{
    public static class OpenXRRuntime
    {
        public static bool IsExtensionEnabled(string extensionName) => OpenXrRuntime.Extensions.Contains(extensionName);
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
            public List<string>? userPaths;
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
