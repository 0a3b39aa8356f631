using System.IO;

namespace UnityShim
{
    /// <summary>The folders of a player.</summary>
    public static class ProjectFolders
    {
        /// <summary>The folder that the test sets, else a temporary one.</summary>
        public static string Persistent { get; set; } =
            Path.Combine(Path.GetTempPath(), "haptoflow-shim-" + Path.GetRandomFileName());
    }
}
