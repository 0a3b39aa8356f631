using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using UnityEditor;
using UnityEditor.Build;
using UnityEditor.Build.Reporting;
using UnityEngine;
using UnityEngine.SceneManagement;
using UnityShim;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    public enum BuildTarget
    {
        StandaloneOSX = 2,
        iOS = 9,
        Android = 13,
        StandaloneWindows64 = 19,
        WebGL = 20,
        StandaloneLinux64 = 24,
    }

    public enum BuildTargetGroup
    {
        Unknown = 0,
        Standalone = 1,
        iOS = 4,
        Android = 7,
    }

    public enum AndroidArchitecture : uint
    {
        None = 0,
        ARMv7 = 1,
        ARM64 = 2,
    }

    public sealed partial class PlayerSettings
    {
        public sealed partial class Android
        {
            public static AndroidArchitecture targetArchitectures { get; set; } = AndroidArchitecture.ARM64;
        }
    }

    public sealed partial class PluginImporter : AssetImporter
    {
        internal readonly BuildTarget[] Platforms;

        internal PluginImporter(string path, BuildTarget[] platforms)
        {
            assetPath = path;
            Platforms = platforms;
        }

        public static PluginImporter[] GetImporters(BuildTarget platform) =>
            BuildHost.Plugins.Where(plugin => plugin.Platforms.Contains(platform)).ToArray();
    }

    public partial class EditorBuildSettingsScene
    {
        public EditorBuildSettingsScene(string path, bool enabled)
        {
            this.path = path;
            this.enabled = enabled;
        }

        public bool enabled { get; set; }
        public string path { get; set; }
    }

    public partial class EditorBuildSettings
    {
        public static EditorBuildSettingsScene[] scenes { get; set; } = new EditorBuildSettingsScene[0];
    }
}

namespace UnityEditor.Android
{
    public interface IPostGenerateGradleAndroidProject : Build.IOrderedCallback
    {
        void OnPostGenerateGradleAndroidProject(string path);
    }
}

namespace UnityEditor.Build
{
    public interface IOrderedCallback
    {
        int callbackOrder { get; }
    }

    public interface IPreprocessBuildWithReport : IOrderedCallback
    {
        void OnPreprocessBuild(BuildReport report);
    }

    public interface IProcessSceneWithReport : IOrderedCallback
    {
        void OnProcessScene(Scene scene, BuildReport report);
    }
}

namespace UnityEditor.Build.Reporting
{
    public partial struct BuildSummary
    {
        public BuildTarget platform { get; internal set; }
    }

    public sealed partial class BuildReport : Object
    {
        internal BuildReport(BuildTarget platform) => summary = new BuildSummary { platform = platform };

        public BuildSummary summary { get; }
    }
}

namespace UnityShim
{
    /// <summary>Calls the callbacks of a player build.</summary>
    public static class BuildHost
    {
        internal static readonly List<PluginImporter> Plugins = new List<PluginImporter>();

        /// <summary>Adds a native library to the project, enabled for some platforms.</summary>
        public static void AddPlugin(string path, params BuildTarget[] platforms) =>
            Plugins.Add(new PluginImporter(path, platforms));

        public static void ForgetPlugins() => Plugins.Clear();

        /// <summary>Calls the callbacks that run before a build.</summary>
        public static void Preprocess(BuildTarget platform)
        {
            var report = new BuildReport(platform);
            foreach (IPreprocessBuildWithReport callback in Callbacks<IPreprocessBuildWithReport>())
            {
                callback.OnPreprocessBuild(report);
            }
        }

        /// <summary>Calls the callbacks that process the open scene for a player, or, without a platform, for play
        /// mode.</summary>
        public static void ProcessScene(BuildTarget? platform)
        {
            BuildReport report = platform.HasValue ? new BuildReport(platform.Value) : null!;
            foreach (IProcessSceneWithReport callback in Callbacks<IProcessSceneWithReport>())
            {
                callback.OnProcessScene(default, report);
            }
        }

        /// <summary>Calls the callbacks that change the Gradle project of an Android player.</summary>
        public static void GenerateGradleProject(string folder)
        {
            foreach (UnityEditor.Android.IPostGenerateGradleAndroidProject callback in
                Callbacks<UnityEditor.Android.IPostGenerateGradleAndroidProject>())
            {
                callback.OnPostGenerateGradleAndroidProject(folder);
            }
        }

        private static IEnumerable<T> Callbacks<T>()
            where T : IOrderedCallback => EditorTypes.All
            .Where(type => typeof(T).IsAssignableFrom(type) && !type.IsInterface && !type.IsAbstract)
            .Select(type => (T)Activator.CreateInstance(type, true))
            .OrderBy(callback => callback.callbackOrder)
            .ToArray();
    }
}

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
