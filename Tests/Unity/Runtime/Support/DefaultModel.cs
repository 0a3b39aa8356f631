#nullable enable
using UnityEngine;

namespace HaptoFlow.Tests
{
    /// <summary>The model of the package.</summary>
    internal static class DefaultModel
    {
#if HAPTOFLOW_OUTSIDE_UNITY
        private static byte[]? file;

        public static HapticModelAsset Asset() => HapticModelAsset.Create(
            file ??= System.IO.File.ReadAllBytes(Support.RepositoryFiles.DefaultModel));
#elif UNITY_EDITOR
        public static HapticModelAsset Asset() => UnityEditor.AssetDatabase.LoadAssetAtPath<HapticModelAsset>(
            "Packages/com.haptoflow.runtime/Runtime/Models/default.haptoflow");
#else
        public static HapticModelAsset Asset() => HaptoFlowSettings.Active.Model!;
#endif
    }
}
