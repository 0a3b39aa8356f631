#nullable enable
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

        private MxInkSupport(bool isLacking, bool canSwitchOn)
        {
            IsLacking = isLacking;
            CanSwitchOn = canSwitchOn;
        }

        /// <summary>True where the project uses Meta's SDK or OpenXR and has no interaction profile of the pen.</summary>
        public bool IsLacking { get; }

        /// <summary>True where <see cref="MxInkSwitch"/> gives the project a profile.</summary>
        public bool CanSwitchOn { get; }

        public static MxInkSupport OfProject()
        {
            bool meta = false;
#if HAPTOFLOW_META
            meta = true;
#endif
            return Of(meta, MxInkSwitch.IsThere, Directory.GetCurrentDirectory());
        }

        /// <param name="meta">True where Meta's SDK is installed.</param>
        /// <param name="openXr">True where Unity's OpenXR plug-in is installed.</param>
        /// <param name="project">The folder of the project.</param>
        internal static MxInkSupport Of(bool meta, bool openXr, string project)
        {
            bool has = (meta && HasActionSet(project)) || (openXr && MxInkSwitch.IsOn);
            return new MxInkSupport((meta || openXr) && !has, openXr && !has);
        }

        private static bool HasActionSet(string project) =>
            new[] { Path.Combine(project, "Assets", "StreamingAssets", BindingsFile), Path.Combine(project, BindingsFile) }
                .Any(path => File.Exists(path) && File.ReadAllText(path).Contains(Profile));
    }
}
