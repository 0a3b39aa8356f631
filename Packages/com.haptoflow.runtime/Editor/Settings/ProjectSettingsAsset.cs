#nullable enable
using System;
using System.Linq;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>The settings asset of the project: the one among the preloaded assets, which players load at their
    /// start, or the one in a Resources folder, which they find there. Nothing is made before somebody asks for it.
    /// </summary>
    internal static class ProjectSettingsAsset
    {
        public const string DefaultModelPath = "Packages/com.haptoflow.runtime/Runtime/Models/default.haptoflow";
        public const string Path = Folder + "/HaptoFlowSettings.asset";
        private const string Folder = "Assets/HaptoFlow";
        private const string InResources = "/Resources/" + HaptoFlowSettings.ResourceName + ".asset";

        private static HaptoFlowSettings? found;
        private static bool searched;

        /// <summary>The preloaded one, else one in a Resources folder, else the first in the project; null where there
        /// is none.</summary>
        public static HaptoFlowSettings? Find()
        {
            if (found == null && !searched)
            {
                found = Preloaded() ?? InProject();
                searched = true;
            }
            return found;
        }

        /// <summary>Looks again: assets came or went.</summary>
        public static void Forget()
        {
            found = null;
            searched = false;
        }

        /// <summary>Whether a player build has it.</summary>
        public static bool ReachesPlayers(HaptoFlowSettings settings) =>
            IsPreloaded(settings) || IsInResources(AssetDatabase.GetAssetPath(settings));

        public static bool IsPreloaded(HaptoFlowSettings settings) =>
            Array.IndexOf(PlayerSettings.GetPreloadedAssets(), settings) >= 0;

        /// <summary>Makes the asset where the project has none, with the package's own model, and puts it among the
        /// preloaded assets where players would not have it.</summary>
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

        /// <summary>Gives the asset to player builds, in the place of another one.</summary>
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

        /// <summary>The model that the package brings; null where it is not there.</summary>
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
            Debug.Log($"HaptoFlow: made {AssetDatabase.GetAssetPath(settings)} and put it among the preloaded assets.",
                settings);
            return settings;
        }
    }
}
