using System;
using System.Linq;
using System.Reflection;
using UnityEditor;
using Object = UnityEngine.Object;

namespace UnityShim
{
    /// <summary>An editor with one open project and one scene, driven by tests.</summary>
    public static class EditorSession
    {
        private static readonly Lazy<MethodInfo[]> LoadMethods = new Lazy<MethodInfo[]>(FindLoadMethods);

        /// <summary>Whether the dark skin is in use.</summary>
        public static bool DarkSkin { get; set; } = true;

        /// <summary>Where this package is installed; null as where the assemblies are of no package.</summary>
        public static string? PackageFolder { get; set; }

        /// <summary>The object that was pinged last.</summary>
        public static Object? Pinged { get; internal set; }

        /// <summary>The path of the settings page that was opened last.</summary>
        public static string? OpenedSettings { get; internal set; }

        /// <summary>Whether Disable Unity Audio is on in the project's settings.</summary>
        public static bool DisablesUnityAudio { set => AudioManager.DisablesAudio = value; }

        /// <summary>Whether the user presses Cancel when asked whether modified scenes are to be saved.</summary>
        public static bool CancelsSaving { get; set; }

        /// <summary>Whether the open scene was marked as modified.</summary>
        public static bool SceneIsDirty { get; internal set; }

        internal static bool StartsPlaying { get; private set; }

        /// <summary>Starts an editor with an empty scene and a project with an Assets folder and this package.
        /// </summary>
        public static void Begin(string packageFolder)
        {
            World.BeginEditing();
            AudioDevice.Reset();
            DisablesUnityAudio = false;
            ProjectFiles.Begin(packageFolder);
            AssetDatabase.Reset();
            Undo.Reset();
            PlayerSettings.SetPreloadedAssets(Array.Empty<Object>());
            Selection.selectionChanged = null;
            Selection.objects = Array.Empty<Object>();
            Pinged = null;
            OpenedSettings = null;
            CancelsSaving = false;
            SceneIsDirty = false;
            Load();
        }

        /// <summary>Deletes the project's folder.</summary>
        public static void End()
        {
            if (World.IsPlaying)
            {
                Stop();
            }
            AssemblyReloadEvents.Announce();
            World.BeginEditing();
            ProjectFiles.End();
        }

        /// <summary>Enters play mode with domain reload off: static fields keep their values.</summary>
        public static void Play()
        {
            StartsPlaying = true;
            EditorApplication.Announce(PlayModeStateChange.ExitingEditMode);
            World.EnterPlayMode();
            StartsPlaying = false;
            EditorApplication.Announce(PlayModeStateChange.EnteredPlayMode);
        }

        public static void Stop()
        {
            EditorApplication.Announce(PlayModeStateChange.ExitingPlayMode);
            World.ExitPlayMode();
            EditorApplication.Announce(PlayModeStateChange.EnteredEditMode);
        }

        /// <summary>Raises the events of a domain reload. Unlike in Unity, static fields keep their values.</summary>
        public static void ReloadScripts()
        {
            AssemblyReloadEvents.Announce();
            Load();
        }

        public static void Quit() => EditorApplication.AnnounceQuit();

        /// <summary>Raises the event for objects that were added, removed or renamed.</summary>
        public static void ChangeHierarchy() => EditorApplication.AnnounceHierarchyChange();

        private static void Load()
        {
            EditorApplication.Forget();
            AssemblyReloadEvents.Forget();
            ObjectChangeEvents.Forget();
            Undo.undoRedoPerformed = null;
            foreach (MethodInfo method in LoadMethods.Value)
            {
                method.Invoke(null, null);
            }
        }

        private static MethodInfo[] FindLoadMethods()
        {
            const BindingFlags anyStatic = BindingFlags.Static | BindingFlags.Public | BindingFlags.NonPublic;
            return EditorTypes.All.SelectMany(type => type.GetMethods(anyStatic))
                .Where(method => method.IsDefined(typeof(InitializeOnLoadMethodAttribute))).ToArray();
        }
    }
}
