using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Reflection;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

namespace UnityEditor
{
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
}

namespace UnityEditor
{
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
        }

        public int version { get; private set; }

        public string[] fileExtensions { get; private set; }
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

        protected Object[] assetTargets => imported;

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
        public static ScriptedImporter? For(string path)
        {
            string extension = Path.GetExtension(path).TrimStart('.');
            Type? type = EditorTypes.All.FirstOrDefault(candidate =>
                candidate.GetCustomAttribute<ScriptedImporterAttribute>()?.fileExtensions.Contains(extension) == true);
            return type == null ? null : (ScriptedImporter)Activator.CreateInstance(type, true);
        }
    }
}
