using System;
using System.IO;

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
