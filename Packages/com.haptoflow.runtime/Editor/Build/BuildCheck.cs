#nullable enable
using System.Collections.Generic;
using System.IO;
using System.Linq;
using UnityEditor;
using UnityEditor.Build;
using UnityEditor.Build.Reporting;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Says in the console, before a player is built, why it would be silent on the device. The build goes on:
    /// a scene runs without haptics, and a team may want it to on a platform that has no library.</summary>
    internal sealed class BuildCheck : IPreprocessBuildWithReport
    {
        private const string LibraryName = "audioplugin_haptoflow";

        private static readonly (BuildTarget Platform, string Command)[] Makeable =
        {
            (BuildTarget.StandaloneLinux64, "`npm run build` on Linux"),
            (BuildTarget.StandaloneWindows64, "`npm run build -- --platform windows-x64`"),
            (BuildTarget.StandaloneOSX, "`npm run build -- --platform macos` on a Mac"),
            (BuildTarget.Android, "`npm run build -- --platform android-arm64`"),
        };

        public int callbackOrder => 0;

        public void OnPreprocessBuild(BuildReport report)
        {
            foreach (Finding finding in Findings(report.summary.platform))
            {
                string text = "HaptoFlow: this build is silent on the device: " + finding.Text;
                UnityEngine.Object? about = finding.Objects.Count > 0 ? finding.Objects[0] : null;
                if (finding.Severity == MessageType.Error)
                {
                    Debug.LogError(text, about);
                }
                else
                {
                    Debug.LogWarning(text, about);
                }
            }
        }

        /// <summary>What keeps a player of a platform from being felt; empty where nothing does.</summary>
        internal static IEnumerable<Finding> Findings(BuildTarget platform)
        {
            Finding? ofLibrary = OfLibrary(platform);
            ProjectSettingsAsset.Forget();
            IEnumerable<Finding> ofSettings = SettingsRules.Check();
            return ofLibrary == null ? ofSettings : ofSettings.Prepend(ofLibrary);
        }

        private static Finding? OfLibrary(BuildTarget platform)
        {
            if (!PluginImporter.GetImporters(platform).Any(IsLibrary))
            {
                return new Finding(MessageType.Error, $"{LibraryName} has no library for {platform}. Libraries are " +
                    $"there for: {Known()}. {Remedy(platform)}");
            }
            bool lacksArm64 = platform == BuildTarget.Android &&
                (PlayerSettings.Android.targetArchitectures & AndroidArchitecture.ARM64) == 0;
            return lacksArm64
                ? new Finding(MessageType.Error, $"{LibraryName} has a library for Android's ARM64 only, and the " +
                    "player's target architectures leave ARM64 out. Choose it, with IL2CPP, in Project Settings > " +
                    "Player > Target Architectures.")
                : null;
        }

        private static string Known()
        {
            string[] known = Makeable.Where(each => PluginImporter.GetImporters(each.Platform).Any(IsLibrary))
                .Select(each => each.Platform.ToString()).ToArray();
            return known.Length > 0 ? string.Join(", ", known) : "no platform";
        }

        private static string Remedy(BuildTarget platform)
        {
            string? command = Makeable.FirstOrDefault(each => each.Platform == platform).Command;
            return command == null
                ? "HaptoFlow has none for this platform."
                : $"In HaptoFlow's repository, {command}, then `npm run pack`, makes a package with it; install that.";
        }

        // GetImporters also lists libraries that the project put elsewhere than the package.
        private static bool IsLibrary(PluginImporter plugin)
        {
            string name = Path.GetFileNameWithoutExtension(plugin.assetPath);
            return name == LibraryName || name == "lib" + LibraryName;
        }
    }
}
