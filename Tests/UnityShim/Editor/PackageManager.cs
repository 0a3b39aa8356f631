using System.Reflection;
using UnityShim;

namespace UnityEditor.PackageManager
{
    public sealed partial class PackageInfo
    {
        private PackageInfo(string folder) => resolvedPath = folder;

        /// <summary>The package's folder on disk.</summary>
        public string resolvedPath { get; }

        public static PackageInfo? FindForAssembly(Assembly assembly) =>
            EditorSession.PackageFolder is { } folder ? new PackageInfo(folder) : null;
    }
}
