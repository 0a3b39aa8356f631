#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Makes imported meshes and textures readable through their import settings.</summary>
    internal static class Readability
    {
        private const string Caption = "Enable Read/Write";

        /// <summary>A button for the imported ones among the assets; none if all were created by scripts. An import
        /// cannot be undone.</summary>
        public static IEnumerable<Repair> RepairsOf(IEnumerable<Object> assets)
        {
            string[] paths = assets.Select(AssetDatabase.GetAssetPath)
                .Where(path => path.Length > 0 && CanEnable(AssetImporter.GetAtPath(path))).Distinct().ToArray();
            return paths.Length == 0
                ? Enumerable.Empty<Repair>()
                : new[] { new Repair(Caption, () => Enable(paths)) };
        }

        private static bool CanEnable(AssetImporter? importer) =>
            importer is TextureImporter || importer is ModelImporter;

        private static void Enable(IEnumerable<string> paths)
        {
            foreach (string path in paths)
            {
                AssetImporter importer = AssetImporter.GetAtPath(path)!;
                if (importer is TextureImporter texture)
                {
                    texture.isReadable = true;
                }
                if (importer is ModelImporter model)
                {
                    model.isReadable = true;
                }
                importer.SaveAndReimport();
            }
        }
    }
}
