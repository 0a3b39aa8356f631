using System;
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEditor.XR.OpenXR.Features;
using UnityEngine.XR.OpenXR.Features;
using UnityShim;

namespace UnityEngine.XR.OpenXR
{
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
