#nullable enable
#if HAPTOFLOW_OPENXR && HAPTOFLOW_INPUT_SYSTEM
using System;
using System.Linq;
using UnityEditor;
using UnityEditor.XR.OpenXR.Features;
using UnityEngine.XR.OpenXR;
#endif

namespace HaptoFlow.Editor
{
    /// <summary>The interaction profile of MX Ink in the settings of Unity's OpenXR plug-in.</summary>
    internal static class MxInkSwitch
    {
#if HAPTOFLOW_OPENXR && HAPTOFLOW_INPUT_SYSTEM
        private static readonly BuildTargetGroup[] Groups = { BuildTargetGroup.Standalone, BuildTargetGroup.Android };

        /// <summary>True where the plug-in is installed.</summary>
        public static bool IsThere => true;

        /// <summary>True where a build target has such a profile, the package's own or another.</summary>
        public static bool IsOn => Groups.Select(OpenXRSettings.GetSettingsForBuildTargetGroup)
            .Any(settings => settings != null && MxInkFeatures.SwitchedOn(settings).Any());

        /// <summary>Switches the package's own profile on, for desktops and for Android.</summary>
        public static void SwitchOn() => Array.ForEach(Groups, group =>
        {
            // Unity makes the feature of a package that is new to the project when its settings are opened.
            FeatureHelpers.RefreshFeatures(group);
            MxInkInteraction? feature =
                OpenXRSettings.GetSettingsForBuildTargetGroup(group)?.GetFeature<MxInkInteraction>();
            if (feature != null)
            {
                Undo.RecordObject(feature, "Switch On Profile of MX Ink");
                feature.enabled = true;
                // Unity's setter leaves the settings unsaved.
                EditorUtility.SetDirty(feature);
            }
        });
#else
        public static bool IsThere => false;

        public static bool IsOn => false;

        public static void SwitchOn()
        {
        }
#endif
    }
}
