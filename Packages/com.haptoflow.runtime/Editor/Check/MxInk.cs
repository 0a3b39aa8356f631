#nullable enable
using System.IO;
using System.Linq;
#if HAPTOFLOW_OPENXR && HAPTOFLOW_INPUT_SYSTEM
using System;
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

    /// <summary>Whether a project tells headsets that it knows MX Ink. Without that, a headset presents the pen as a
    /// Touch controller.</summary>
    internal readonly struct MxInkSupport
    {
        // Meta's SDK writes the action sets of the project into this file.
        private const string BindingsFile = "RuntimeActionBindings.json";
        private const string Profile = "mx_ink_stylus_logitech";

        /// <summary>True where the project uses Meta's SDK or OpenXR and has no interaction profile of the pen.</summary>
        public bool IsLacking { get; init; }

        /// <summary>True where <see cref="MxInkSwitch"/> gives the project a profile.</summary>
        public bool CanSwitchOn { get; init; }

        public static MxInkSupport OfProject()
        {
            bool meta = false;
#if HAPTOFLOW_META
            meta = true;
#endif
            return Of(meta, MxInkSwitch.IsThere, Directory.GetCurrentDirectory());
        }

        /// <param name="meta">True where Meta's SDK is installed.</param>
        /// <param name="openXr">True where Unity's OpenXR plug-in is installed.</param>
        /// <param name="project">The folder of the project.</param>
        internal static MxInkSupport Of(bool meta, bool openXr, string project)
        {
            bool has = (meta && HasActionSet(project)) || (openXr && MxInkSwitch.IsOn);
            return new MxInkSupport { IsLacking = (meta || openXr) && !has, CanSwitchOn = openXr && !has };
        }

        private static bool HasActionSet(string project) =>
            new[] { Path.Combine(project, "Assets", "StreamingAssets", BindingsFile), Path.Combine(project, BindingsFile) }
                .Any(path => File.Exists(path) && File.ReadAllText(path).Contains(Profile));
    }
}
