using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Reflection;
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

        public static void SetImporterOverride<T>(string path)
            where T : AssetImporter
        {
            if (!ScriptedImporters.Takes(typeof(T), path, true))
            {
                Debug.LogError(
                    $"Cannot set Importer override at {path} because {typeof(T).Name} is not a valid Importer for this asset.");
                return;
            }
            ScriptedImporters.Overrides[path] = typeof(T);
            ImportAsset(path);
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
            ScriptedImporters.Overrides.Clear();
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

    public partial class AssetImporter : Object
    {
        internal List<AssetImporters.ImportLog.ImportLogEntry> Entries =
            new List<AssetImporters.ImportLog.ImportLogEntry>();

        public string assetPath { get; internal set; } = "";

        public void SaveAndReimport() => AssetDatabase.ImportAsset(assetPath);

        public static AssetImporter? GetAtPath(string path) => AssetDatabase.Importer(path);

        public static AssetImporters.ImportLog? GetImportLog(string path) =>
            GetAtPath(path) is { } importer && importer.Entries.Count > 0
                ? new AssetImporters.ImportLog(importer.Entries.ToArray())
                : null;
    }

    public sealed partial class TextureImporter : AssetImporter
    {
        public bool isReadable { get; set; }
    }

    public partial class ModelImporter : AssetImporter
    {
        public bool isReadable { get; set; }
    }
}

namespace UnityEditorInternal
{
    public partial class InternalEditorUtility
    {
        public static string[] tags => UnityShim.ProjectNames.Tags.ToArray();
    }
}

namespace UnityEditor.AssetImporters
{
    [Flags]
    public enum ImportLogFlags
    {
        None = 0,
        Error = 64,
        Warning = 128,
    }

    public sealed partial class ImportLog : Object
    {
        internal ImportLog(ImportLogEntry[] entries) => logEntries = entries;

        public ImportLogEntry[] logEntries { get; }

        public struct ImportLogEntry
        {
            public string message;
            public ImportLogFlags flags;
        }
    }

    [AttributeUsage(AttributeTargets.Class, Inherited = false)]
    public partial class ScriptedImporterAttribute : Attribute
    {
        public ScriptedImporterAttribute(int version, string ext)
        {
            this.version = version;
            fileExtensions = new[] { ext };
            overrideFileExtensions = Array.Empty<string>();
        }

        public ScriptedImporterAttribute(int version, string[] exts, string[] overrideExts)
        {
            this.version = version;
            fileExtensions = exts;
            overrideFileExtensions = overrideExts;
        }

        public int version { get; private set; }
        public string[] fileExtensions { get; private set; }
        public string[] overrideFileExtensions { get; private set; }
    }

    public partial class AssetImportContext
    {
        internal readonly List<ImportLog.ImportLogEntry> Entries = new List<ImportLog.ImportLogEntry>();
        private readonly Dictionary<string, Object> objects = new Dictionary<string, Object>();

        internal AssetImportContext(string path) => assetPath = path;

        public string assetPath { get; internal set; }
        public Object? mainObject { get; private set; }

        public void AddObjectToAsset(string identifier, Object obj) => objects.Add(identifier, obj);

        public void SetMainObject(Object obj)
        {
            if (!objects.ContainsValue(obj))
            {
                throw new InvalidOperationException("the main object was not added to the asset");
            }
            mainObject = obj;
        }

        public void DependsOnSourceAsset(string path)
        {
        }

        public void LogImportError(string msg, Object? obj = null)
        {
            Entries.Add(new ImportLog.ImportLogEntry { message = msg, flags = ImportLogFlags.Error });
            Debug.LogError(msg, obj);
        }

        public void LogImportWarning(string msg, Object? obj = null)
        {
            Entries.Add(new ImportLog.ImportLogEntry { message = msg, flags = ImportLogFlags.Warning });
            Debug.LogWarning(msg, obj);
        }
    }

    public abstract partial class ScriptedImporter : AssetImporter
    {
        public abstract void OnImportAsset(AssetImportContext ctx);
    }

    public abstract partial class AssetImporterEditor : Editor
    {
        private Object[] imported = Array.Empty<Object>();

        public virtual bool showImportedObject => true;

        protected virtual bool needsApplyRevert => true;

        protected Object? assetTarget => imported.Length > 0 ? imported[0] : null;

        public virtual void OnEnable()
        {
        }

        public virtual void OnDisable()
        {
        }

        internal override void Prepare() => imported = targets
            .Select(importer => AssetDatabase.LoadMainAssetAtPath(((AssetImporter)importer).assetPath)!).ToArray();
    }

    public partial class ScriptedImporterEditor : AssetImporterEditor
    {
    }

    internal static class ScriptedImporters
    {
        /// <summary>The importers that were chosen for files.</summary>
        public static readonly Dictionary<string, Type> Overrides = new Dictionary<string, Type>();

        public static ScriptedImporter? For(string path)
        {
            Type? type = Overrides.TryGetValue(path, out Type? chosen)
                ? chosen
                : EditorTypes.All.FirstOrDefault(candidate => Takes(candidate, path, false));
            return type == null ? null : (ScriptedImporter)Activator.CreateInstance(type, true);
        }

        public static bool Takes(Type importer, string path, bool asOverride)
        {
            var attribute = importer.GetCustomAttribute<ScriptedImporterAttribute>();
            string[]? endings = asOverride ? attribute?.overrideFileExtensions : attribute?.fileExtensions;
            return endings?.Contains(Path.GetExtension(path).TrimStart('.'), StringComparer.OrdinalIgnoreCase) == true;
        }
    }
}

namespace UnityShim
{
    /// <summary>The folder of a project: Assets in a temporary folder, which is the working directory as in Unity, and
    /// one package, read from the repository.</summary>
    internal static class ProjectFiles
    {
        private const string PackagePrefix = "Packages/com.haptoflow.runtime";
        private static string? folder;
        private static string package = "";
        private static string outside = "";

        public static void Begin(string packageFolder)
        {
            End();
            package = packageFolder;
            outside = Environment.CurrentDirectory;
            folder = Path.Combine(Path.GetTempPath(), "haptoflow-project-" + Guid.NewGuid().ToString("N"));
            Directory.CreateDirectory(Path.Combine(folder, "Assets"));
            Environment.CurrentDirectory = folder;
        }

        public static void End()
        {
            if (folder != null)
            {
                Environment.CurrentDirectory = outside;
                Directory.Delete(folder, true);
                folder = null;
            }
        }

        /// <summary>The path on disk of an asset path.</summary>
        public static string Physical(string path) => path.StartsWith(PackagePrefix, StringComparison.Ordinal)
            ? package + path.Substring(PackagePrefix.Length)
            : Path.Combine(folder ?? throw new InvalidOperationException("no project is open"), path);
    }
}
