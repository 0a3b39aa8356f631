using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using UnityEditor.AssetImporters;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    public sealed partial class AssetDatabase
    {
        private static readonly Dictionary<string, Object> Assets = new Dictionary<string, Object>();
        private static readonly Dictionary<string, AssetImporter> Importers = new Dictionary<string, AssetImporter>();

        public static void CreateAsset(Object asset, string path)
        {
            if (!Directory.Exists(ProjectFiles.Physical(Path.GetDirectoryName(path)!)) || Contains(asset))
            {
                throw new ArgumentException($"Couldn't create asset file: {path}");
            }
            File.WriteAllText(ProjectFiles.Physical(path), "an asset of the shim");
            asset.name = Path.GetFileNameWithoutExtension(path);
            Assets[path] = asset;
            EditorApplication.AnnounceProjectChange();
        }

        public static bool Contains(Object obj) => Assets.ContainsValue(obj);

        public static string GetAssetPath(Object assetObject) =>
            Assets.FirstOrDefault(entry => ReferenceEquals(entry.Value, assetObject)).Key ?? "";

        public static T LoadAssetAtPath<T>(string assetPath)
            where T : Object => (LoadMainAssetAtPath(assetPath) as T)!;

        public static Object? LoadMainAssetAtPath(string assetPath)
        {
            if (!Assets.ContainsKey(assetPath) && File.Exists(ProjectFiles.Physical(assetPath)))
            {
                ImportAsset(assetPath);
            }
            return Assets.TryGetValue(assetPath, out Object? asset) ? asset : null;
        }

        public static Object[] LoadAllAssetsAtPath(string assetPath) => assetPath == AudioManager.Path
            ? new Object[] { AudioManager.OfProject }
            : LoadMainAssetAtPath(assetPath) is { } asset ? new[] { asset } : Array.Empty<Object>();

        public static void ImportAsset(string path)
        {
            ScriptedImporter? importer = ScriptedImporters.For(path);
            if (importer == null && IsText(path))
            {
                // Unity leaves out the last ending of a file in the asset's name.
                Assets[path] = new TextAsset(File.ReadAllBytes(ProjectFiles.Physical(path)))
                {
                    name = Path.GetFileNameWithoutExtension(path),
                };
                return;
            }
            if (importer == null || !File.Exists(ProjectFiles.Physical(path)))
            {
                return;
            }
            var context = new AssetImportContext(path);
            importer.assetPath = path;
            importer.OnImportAsset(context);
            importer.Entries = context.Entries;
            Importers[path] = importer;
            if (context.mainObject is { } main)
            {
                main.name = Path.GetFileNameWithoutExtension(path);
                Assets[path] = main;
            }
            EditorApplication.AnnounceProjectChange();
        }

        private static bool IsText(string path) =>
            Array.IndexOf(new[] { ".bytes", ".csv", ".json", ".txt" }, Path.GetExtension(path)) >= 0;

        /// <summary>Finds assets by the filter t:TypeName only.</summary>
        public static string[] FindAssets(string filter) => filter.StartsWith("t:", StringComparison.Ordinal)
            ? Assets.Where(entry => entry.Value.GetType().Name == filter.Substring(2))
                .Select(entry => AssetPathToGUID(entry.Key)).ToArray()
            : throw new NotSupportedException("the shim finds assets by type only");

        public static string AssetPathToGUID(string path) =>
            new Guid(System.Security.Cryptography.MD5.Create().ComputeHash(System.Text.Encoding.UTF8.GetBytes(path)))
                .ToString("N");

        public static string GUIDToAssetPath(string guid) =>
            Assets.Keys.FirstOrDefault(path => AssetPathToGUID(path) == guid) ?? "";

        /// <summary>What each asset depends on; tests set it.</summary>
        internal static readonly Dictionary<string, string[]> Dependencies = new Dictionary<string, string[]>();

        public static string[] GetDependencies(string pathName, bool recursive) => Dependencies
            .TryGetValue(pathName, out string[] found) ? found.Prepend(pathName).ToArray() : new[] { pathName };

        public static bool IsValidFolder(string path) => Directory.Exists(ProjectFiles.Physical(path));

        public static string CreateFolder(string parentFolder, string newFolderName)
        {
            string path = parentFolder + "/" + newFolderName;
            Directory.CreateDirectory(ProjectFiles.Physical(path));
            return AssetPathToGUID(path);
        }

        public static string GenerateUniqueAssetPath(string path)
        {
            string candidate = path;
            for (int number = 1; File.Exists(ProjectFiles.Physical(candidate)); ++number)
            {
                candidate = Path.ChangeExtension(path, null) + " " + number + Path.GetExtension(path);
            }
            return candidate;
        }

        public static bool DeleteAsset(string path)
        {
            string physical = ProjectFiles.Physical(path);
            bool folder = Directory.Exists(physical);
            bool there = folder || File.Exists(physical);
            if (folder)
            {
                Directory.Delete(physical, true);
            }
            else if (there)
            {
                File.Delete(physical);
            }
            foreach (string gone in Assets.Keys.Where(each => each == path || each.StartsWith(path + "/")).ToList())
            {
                Object.DestroyImmediate(Assets[gone], true);
                Assets.Remove(gone);
            }
            return there;
        }

        public static void SaveAssetIfDirty(Object obj)
        {
        }

        /// <summary>Adds an asset as one of Unity's importers would create it.</summary>
        internal static void AddImported(string path, Object asset, AssetImporter importer)
        {
            importer.assetPath = path;
            Assets[path] = asset;
            Importers[path] = importer;
        }

        internal static AssetImporter? Importer(string path) =>
            Importers.TryGetValue(path, out AssetImporter? importer) ? importer : null;

        internal static void Reset()
        {
            Dependencies.Clear();
            // Imported once for all projects: packages do not change, and importing a model takes long.
            foreach (string path in Assets.Keys.Where(each => !each.StartsWith("Packages/")).ToList())
            {
                Assets.Remove(path);
                Importers.Remove(path);
            }
        }
    }

    public partial class FileUtil
    {
        public static string GetPhysicalPath(string path) => ProjectFiles.Physical(path);
    }
}
