using System;
using System.Linq;
using System.Reflection;
using UnityEditor;
using Object = UnityEngine.Object;

namespace UnityShim
{
    /// <summary>One editor with one open project and one scene. Tests turn its crank.</summary>
    public static class EditorSession
    {
        private static readonly Lazy<MethodInfo[]> LoadMethods = new Lazy<MethodInfo[]>(FindLoadMethods);

        /// <summary>Which skin is on.</summary>
        public static bool DarkSkin { get; set; } = true;

        /// <summary>What was pinged last.</summary>
        public static Object? Pinged { get; internal set; }

        /// <summary>Path of the settings page that was opened last.</summary>
        public static string? OpenedSettings { get; internal set; }

        internal static bool StartsPlaying { get; private set; }

        /// <summary>An editor that was just started: an empty scene, a project with an Assets folder and this package.
        /// </summary>
        public static void Begin(string packageFolder)
        {
            World.BeginEditing();
            AudioDevice.Reset();
            ProjectFiles.Begin(packageFolder);
            AssetDatabase.Reset();
            Undo.Reset();
            PlayerSettings.SetPreloadedAssets(Array.Empty<Object>());
            Selection.selectionChanged = null;
            Selection.objects = Array.Empty<Object>();
            Pinged = null;
            OpenedSettings = null;
            Load();
        }

        /// <summary>The project's folder goes.</summary>
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

        /// <summary>Play mode with domain reload off: statics stay.</summary>
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

        /// <summary>What editor code sees of a domain reload; its statics stay here.</summary>
        public static void ReloadScripts()
        {
            AssemblyReloadEvents.Announce();
            Load();
        }

        public static void Quit() => EditorApplication.AnnounceQuit();

        /// <summary>Something in the scene came, went or changed its name.</summary>
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
