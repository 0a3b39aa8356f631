#nullable enable
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text.RegularExpressions;
using System.Xml.Linq;
using UnityEditor;
using UnityEditor.Android;
using UnityEditor.Build;
using UnityEditor.Build.Reporting;
using UnityEngine;
using UnityEngine.SceneManagement;

namespace HaptoFlow.Editor
{
    /// <summary>Writes to the console, before a player is built, why its haptics would be silent. The build continues,
    /// because a scene also runs without haptics.</summary>
    internal sealed class BuildCheck : IPreprocessBuildWithReport
    {
        // Not the name that the imports use, which is __Internal while the build target is iOS.
        private const string LibraryName = "audioplugin_haptoflow";

        // Git has the libraries of Linux and Windows; the command for the others puts theirs into the package beside them.
        private static readonly (BuildTarget Platform, string Command, bool IsInGit)[] BuildCommands =
        {
            (BuildTarget.StandaloneLinux64, "`npm run build` on Linux", true),
            (BuildTarget.StandaloneWindows64, "`npm run build -- --platform windows-x64`", true),
            (BuildTarget.StandaloneOSX, "`npm run build -- --platform macos` on a Mac", false),
            (BuildTarget.Android, "`npm run build -- --platform android-arm64`", false),
        };

        public int callbackOrder => 0;

        public void OnPreprocessBuild(BuildReport report)
        {
            foreach (Finding finding in Findings(report.summary.platform))
            {
                string text = "HaptoFlow: this build has no haptics: " + finding.Text;
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

        /// <summary>The problems that silence the haptics of a player on a platform.</summary>
        internal static IEnumerable<Finding> Findings(BuildTarget platform)
        {
            Finding? libraryFinding = LibraryFinding(platform);
            ProjectSettingsAsset.Forget();
            IEnumerable<Finding> settingsFindings = SettingsRules.Check();
            return libraryFinding == null ? settingsFindings : settingsFindings.Prepend(libraryFinding);
        }

        private static Finding? LibraryFinding(BuildTarget platform)
        {
            if (!PluginImporter.GetImporters(platform).Any(IsLibrary))
            {
                return new Finding(MessageType.Error, $"{LibraryName} has no library for {platform}. There are " +
                    $"libraries for: {PlatformsWithLibrary()}. {Remedy(platform)}");
            }
            bool lacksArm64 = platform == BuildTarget.Android &&
                (PlayerSettings.Android.targetArchitectures & AndroidArchitecture.ARM64) == 0;
            return lacksArm64
                ? new Finding(MessageType.Error, $"{LibraryName} has a library for Android's ARM64 only, but the " +
                    "player's target architectures do not include ARM64. Choose it, with IL2CPP, in Project Settings " +
                    "> Player > Target Architectures.")
                : null;
        }

        private static string PlatformsWithLibrary()
        {
            string[] known = BuildCommands.Where(each => PluginImporter.GetImporters(each.Platform).Any(IsLibrary))
                .Select(each => each.Platform.ToString()).ToArray();
            return known.Length > 0 ? string.Join(", ", known) : "no platform";
        }

        private static string Remedy(BuildTarget platform)
        {
            (_, string? command, bool isInGit) = BuildCommands.FirstOrDefault(each => each.Platform == platform);
            if (command == null)
            {
                return "HaptoFlow cannot build one for this platform.";
            }
            string pack = "`npm run pack`, builds a package that includes it; install that package.";
            return isInGit
                ? $"In HaptoFlow's repository, {command}, then {pack}"
                : $"In HaptoFlow's repository, {command} gives it to the project there. For another project this, then " +
                    pack;
        }

        // By name, because GetImporters also lists libraries that the project keeps outside the package.
        private static bool IsLibrary(PluginImporter plugin)
        {
            string name = Path.GetFileNameWithoutExtension(plugin.assetPath);
            return name == LibraryName || name == "lib" + LibraryName;
        }
    }

    /// <summary>Adds the entry of Meta's experimental features to the manifest of an Android player whose scenes play
    /// parametric haptics: without it the headset refuses them. Only the author's <see
    /// cref="ControllerParametricOutput.UseExperimentalFeature"/> causes it, because Meta's store does not accept such an
    /// application.</summary>
    /// <remarks>Reads the files of the scenes and of their prefabs, since Unity does not process scenes again that have
    /// not changed since the last build.</remarks>
    internal sealed class ParametricManifestEntry : IPostGenerateGradleAndroidProject
    {
        private const string Feature = "com.oculus.experimental.enabled";
        private static readonly XNamespace Android = "http://schemas.android.com/apk/res/android";

        // As Unity writes it into a component, or into a scene that overrides a prefab.
        private static readonly Regex IsUsed =
            new Regex(@"useExperimentalFeature(: 1\b|\s+value: 1\b)", RegexOptions.CultureInvariant);

        // Meta's SDK writes the manifest at 99999, and removes the entry while its own setting is off.
        public int callbackOrder => 100000;

        public void OnPostGenerateGradleAndroidProject(string path)
        {
            string? user = EditorBuildSettings.scenes
                .Where(scene => scene.enabled)
                .SelectMany(scene => AssetDatabase.GetDependencies(scene.path, true))
                .FirstOrDefault(PlaysParametric);
            if (user != null && AddEntry(Path.Combine(path, "src", "main", "AndroidManifest.xml")))
            {
                Debug.Log($"HaptoFlow: {user} plays parametric haptics, so {Feature} was added to the manifest. Meta's " +
                    "store does not accept this application, and experimental features must be enabled on the headset.");
            }
        }

        private static bool PlaysParametric(string asset)
        {
            string extension = Path.GetExtension(asset);
            string file = FileUtil.GetPhysicalPath(asset);
            return (extension == ".unity" || extension == ".prefab") && File.Exists(file) &&
                IsUsed.IsMatch(File.ReadAllText(file));
        }

        private static bool AddEntry(string file)
        {
            if (!File.Exists(file))
            {
                Debug.LogWarning($"HaptoFlow: this build has no {file}: add <uses-feature android:name=\"{Feature}\" " +
                    "android:required=\"true\"/> to its manifest, or parametric haptics stay silent.");
                return false;
            }
            XDocument manifest = XDocument.Load(file);
            XElement root = manifest.Root!;
            bool has = root.Elements("uses-feature").Any(each => (string?)each.Attribute(Android + "name") == Feature);
            if (!has)
            {
                root.Add(new XElement("uses-feature",
                    new XAttribute(Android + "name", Feature), new XAttribute(Android + "required", "true")));
                manifest.Save(file);
            }
            return !has;
        }
    }

    /// <summary>Writes the render pipeline's default material into every <see cref="PipelineMaterial"/> of a scene that
    /// goes into a player or into play mode. The scene's file does not change. Through the scene, players get the
    /// material and its shader.</summary>
    internal sealed class SceneMaterials : IProcessSceneWithReport
    {
        public int callbackOrder => 0;

        public void OnProcessScene(Scene scene, BuildReport report)
        {
            var found = new List<PipelineMaterial>();
            foreach (GameObject root in scene.GetRootGameObjects())
            {
                root.GetComponentsInChildren(true, found);
                foreach (PipelineMaterial each in found)
                {
                    if (each.Material == null)
                    {
                        each.Material = PipelineMaterial.OfPipeline();
                    }
                }
            }
        }
    }
}
