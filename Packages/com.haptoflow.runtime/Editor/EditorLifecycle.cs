#nullable enable
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;
using PackageInfo = UnityEditor.PackageManager.PackageInfo;

namespace HaptoFlow.Editor
{
    /// <summary>Shuts the engine down when scripts reload, play mode changes or the editor quits, and gives play mode
    /// the project's settings. Works with domain reload on and off.</summary>
    internal static class EditorLifecycle
    {
        private static HaptoFlowSettings? builtIn;

        [InitializeOnLoadMethod]
        internal static void Begin()
        {
            HaptoFlowSettings.FindProjectSettings = SettingsOfProject;
            HelpPages.FindPackage = FolderOfPackage;
            UnityAudio.IsDisabledByProject = ProjectAudio.IsDisabled;
            AssemblyReloadEvents.beforeAssemblyReload += HapticSession.ShutDown;
            AssemblyReloadEvents.beforeAssemblyReload += HapticLearning.EndAll;
            AssemblyReloadEvents.beforeAssemblyReload += ForgetBuiltIn;
            EditorApplication.quitting += HapticSession.ShutDown;
            EditorApplication.quitting += HapticLearning.EndAll;
            EditorApplication.playModeStateChanged += OnPlayModeChanged;
            EditorApplication.projectChanged += ProjectSettingsAsset.Forget;
            // In play mode, names of objects are read again only after this call, because reading them allocates.
            EditorApplication.hierarchyChanged += MaterialMaps.Change;
            EditorApplication.hierarchyChanged += SurfaceSeedKeeper.Renew;
        }

        private static string? FolderOfPackage() =>
            PackageInfo.FindForAssembly(typeof(HapticSurface).Assembly)?.resolvedPath;

        private static void OnPlayModeChanged(PlayModeStateChange change)
        {
            if (change == PlayModeStateChange.ExitingEditMode || change == PlayModeStateChange.EnteredEditMode)
            {
                HapticSession.ShutDown();
                HaptoFlowSettings.Forget();
                ProjectSettingsAsset.Forget();
                ForgetBuiltIn();
            }
        }

        // HideAndDontSave objects survive a domain reload, so they have to be destroyed explicitly.
        private static void ForgetBuiltIn()
        {
            if (builtIn != null)
            {
                Object.DestroyImmediate(builtIn);
            }
        }

        private static HaptoFlowSettings? SettingsOfProject()
        {
            HaptoFlowSettings? settings = ProjectSettingsAsset.Find();
            return settings != null ? settings : BuiltIn();
        }

        /// <summary>Settings with the package's model for projects without settings, so that a first scene plays at
        /// once.</summary>
        private static HaptoFlowSettings? BuiltIn()
        {
            HapticModelAsset? model = ProjectSettingsAsset.DefaultModel();
            if (model == null)
            {
                return null;
            }
            if (builtIn == null)
            {
                builtIn = ScriptableObject.CreateInstance<HaptoFlowSettings>();
                builtIn.hideFlags = HideFlags.HideAndDontSave;
                builtIn.name = "Built-in HaptoFlow Settings";
            }
            builtIn.Model = model;
            if (Application.isPlaying)
            {
                Debug.Log("HaptoFlow: this project has no settings, so the editor uses built-in ones with the " +
                    "package's model. Player builds need settings: create them in Project Settings > HaptoFlow.");
            }
            return builtIn;
        }
    }
}
