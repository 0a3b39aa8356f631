#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Ties the engine to the editor's life: it must not outlive the scripts, play mode or the process that
    /// hold it, and play mode takes the project's settings. Holds with domain reload on and off.</summary>
    internal static class EditorLifecycle
    {
        private static HaptoFlowSettings? builtIn;

        [InitializeOnLoadMethod]
        internal static void Begin()
        {
            HaptoFlowSettings.OfProject = SettingsOfProject;
            AssemblyReloadEvents.beforeAssemblyReload += HapticSession.ShutDown;
            AssemblyReloadEvents.beforeAssemblyReload += HapticLearning.EndAll;
            AssemblyReloadEvents.beforeAssemblyReload += ForgetBuiltIn;
            EditorApplication.quitting += HapticSession.ShutDown;
            EditorApplication.quitting += HapticLearning.EndAll;
            EditorApplication.playModeStateChanged += OnPlayModeChanged;
            EditorApplication.projectChanged += ProjectSettingsAsset.Forget;
            // A running scene does not look for new names by itself: reading them makes garbage.
            EditorApplication.hierarchyChanged += MaterialMaps.Change;
        }

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

        // Not saved with any scene, it would stay in memory from one reload to the next.
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

        /// <summary>So that a first scene plays before anybody has looked for settings.</summary>
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
                Debug.Log("HaptoFlow: this project has no settings, so the package's own model plays with " +
                    "built-in ones. Player builds need them: Project Settings > HaptoFlow.");
            }
            return builtIn;
        }
    }
}
