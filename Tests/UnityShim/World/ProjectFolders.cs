using System.IO;

namespace UnityShim
{
    /// <summary>Where a player keeps its files.</summary>
    public static class ProjectFolders
    {
        /// <summary>Of the test's own; a temporary folder where it names none.</summary>
        public static string Persistent { get; set; } =
            Path.Combine(Path.GetTempPath(), "haptoflow-shim-" + Path.GetRandomFileName());
    }
}
