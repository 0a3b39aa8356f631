#nullable enable
using System;
using System.Linq;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>Finds and creates the settings asset of the project. Player builds include it as a preloaded asset, or
    /// from a Resources folder.</summary>
    internal static class ProjectSettingsAsset
    {
        public const string DefaultModelPath = "Packages/com.haptoflow.runtime/Runtime/Models/default.haptoflow";
        public const string Path = Folder + "/HaptoFlowSettings.asset";
        private const string Folder = "Assets/HaptoFlow";
        private const string InResources = "/Resources/" + HaptoFlowSettings.ResourceName + ".asset";

        private static HaptoFlowSettings? found;
        private static bool searched;

        /// <summary>The preloaded settings, else those in a Resources folder, else the first in the project; null
        /// without settings.</summary>
        public static HaptoFlowSettings? Find()
        {
            if (found == null && !searched)
            {
                found = Preloaded() ?? InProject();
                searched = true;
            }
            return found;
        }

        /// <summary>Searches again at the next call, because assets may have changed.</summary>
        public static void Forget()
        {
            found = null;
            searched = false;
        }

        public static bool ReachesPlayers(HaptoFlowSettings settings) =>
            IsPreloaded(settings) || IsInResources(AssetDatabase.GetAssetPath(settings));

        public static bool IsPreloaded(HaptoFlowSettings settings) =>
            Array.IndexOf(PlayerSettings.GetPreloadedAssets(), settings) >= 0;

        /// <summary>The settings of the project. Creates them with the package's model if there are none, and adds them
        /// to the preloaded assets if player builds would not include them.</summary>
        public static HaptoFlowSettings FindOrCreate()
        {
            Forget();
            HaptoFlowSettings? settings = Find();
            if (settings == null)
            {
                settings = Create();
            }
            if (!ReachesPlayers(settings))
            {
                Preload(settings);
            }
            found = settings;
            return settings;
        }

        /// <summary>Adds the settings to the preloaded assets, in place of any other settings.</summary>
        public static void Preload(HaptoFlowSettings settings)
        {
            if (IsPreloaded(settings))
            {
                return;
            }
            PlayerSettings.SetPreloadedAssets(PlayerSettings.GetPreloadedAssets()
                .Where(asset => !(asset is HaptoFlowSettings))
                .Append(settings)
                .ToArray());
            Forget();
        }

        /// <summary>The model of the package; null if it is missing.</summary>
        public static HapticModelAsset? DefaultModel() =>
            AssetDatabase.LoadAssetAtPath<HapticModelAsset>(DefaultModelPath);

        private static HaptoFlowSettings? Preloaded() =>
            PlayerSettings.GetPreloadedAssets().OfType<HaptoFlowSettings>().FirstOrDefault(asset => asset != null);

        private static HaptoFlowSettings? InProject() => AssetDatabase.FindAssets("t:" + nameof(HaptoFlowSettings))
            .Select(AssetDatabase.GUIDToAssetPath)
            .Where(path => path.StartsWith("Assets/", StringComparison.Ordinal))
            .OrderByDescending(IsInResources)
            .ThenBy(path => path, StringComparer.Ordinal)
            .Select(AssetDatabase.LoadAssetAtPath<HaptoFlowSettings>)
            .FirstOrDefault(asset => asset != null);

        private static bool IsInResources(string path) => path.EndsWith(InResources, StringComparison.Ordinal);

        private static HaptoFlowSettings Create()
        {
            if (!AssetDatabase.IsValidFolder(Folder))
            {
                AssetDatabase.CreateFolder("Assets", "HaptoFlow");
            }
            var settings = ScriptableObject.CreateInstance<HaptoFlowSettings>();
            settings.Model = DefaultModel();
            AssetDatabase.CreateAsset(settings, AssetDatabase.GenerateUniqueAssetPath(Path));
            AssetDatabase.SaveAssetIfDirty(settings);
            Debug.Log($"HaptoFlow: created {AssetDatabase.GetAssetPath(settings)} and added it to the preloaded " +
                "assets.",
                settings);
            return settings;
        }
    }

    /// <summary>The project's audio settings, which Unity gives scripts no property for.</summary>
    internal static class ProjectAudio
    {
        private const string SettingsPath = "ProjectSettings/AudioManager.asset";

        /// <summary>Whether Project Settings > Audio > Disable Unity Audio is on.</summary>
        public static bool IsDisabled()
        {
            foreach (Object settings in AssetDatabase.LoadAllAssetsAtPath(SettingsPath))
            {
                using var serialized = new SerializedObject(settings);
                SerializedProperty? disabled = serialized.FindProperty("m_DisableAudio");
                if (disabled != null)
                {
                    return disabled.boolValue;
                }
            }
            return false;
        }
    }
}
