#nullable enable
using System;
using System.IO;
using System.Linq;

namespace HaptoFlow.Editor
{
    /// <summary>Whether a project tells headsets that it knows MX Ink. Without that, a headset presents the pen as a
    /// Touch controller.</summary>
    internal readonly struct MxInkSupport
    {
        // Meta's SDK writes the action sets of the project into this file.
        private const string BindingsFile = "RuntimeActionBindings.json";
        private const string Profile = "mx_ink_stylus_logitech";

        public MxInkSupport(bool isLacking) => IsLacking = isLacking;

        /// <summary>True where the project uses Meta's SDK or OpenXR and has no interaction profile of the pen.</summary>
        public bool IsLacking { get; }

        public static MxInkSupport OfProject()
        {
            bool meta = false;
            bool openXr = false;
#if HAPTOFLOW_META
            meta = true;
#endif
#if HAPTOFLOW_OPENXR
            openXr = true;
#endif
            return Of(meta, openXr, Directory.GetCurrentDirectory());
        }

        /// <param name="meta">True where Meta's SDK is installed.</param>
        /// <param name="openXr">True where Unity's OpenXR plug-in is installed.</param>
        /// <param name="project">The folder of the project.</param>
        internal static MxInkSupport Of(bool meta, bool openXr, string project)
        {
            bool has = (meta && HasActionSet(project)) || (openXr && HasFeature(project));
            return new MxInkSupport((meta || openXr) && !has);
        }

        private static bool HasActionSet(string project) =>
            new[] { Path.Combine(project, "Assets", "StreamingAssets", BindingsFile), Path.Combine(project, BindingsFile) }
                .Any(path => File.Exists(path) && File.ReadAllText(path).Contains(Profile));

        // Logitech's package brings the feature as a script of the project.
        private static bool HasFeature(string project)
        {
            string assets = Path.Combine(project, "Assets");
            return Directory.Exists(assets) && Directory
                .EnumerateFiles(assets, "*.cs", SearchOption.AllDirectories)
                .Select(path => Path.GetFileName(path).Replace("_", "").Replace(" ", ""))
                .Any(name => name.IndexOf("MxInk", StringComparison.OrdinalIgnoreCase) >= 0);
        }
    }
}
