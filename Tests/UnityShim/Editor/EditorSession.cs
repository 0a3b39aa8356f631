using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using UnityEditor;
using UnityEngine;
using UnityEngine.SceneManagement;
using UnityShim;
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

    /// <summary>The project's audio settings, which scripts read as an asset.</summary>
    internal sealed class AudioManager : Object
    {
        public const string Path = "ProjectSettings/AudioManager.asset";

        public static readonly AudioManager OfProject = new AudioManager();

        [SerializeField]
        private bool m_DisableAudio;

        public static bool DisablesAudio { set => OfProject.m_DisableAudio = value; }
    }
}

namespace UnityEditor
{
    public enum PlayModeStateChange
    {
        EnteredEditMode = 0,
        ExitingEditMode = 1,
        EnteredPlayMode = 2,
        ExitingPlayMode = 3,
    }

    public sealed partial class EditorApplication
    {
        public delegate void CallbackFunction();

        public static CallbackFunction? delayCall;
        public static CallbackFunction? update;

        public static double timeSinceStartup => Clock.UnscaledSeconds;

        public static event Action? quitting;
        public static event Action? hierarchyChanged;
        public static event Action? projectChanged;
        public static event Action<PlayModeStateChange>? playModeStateChanged;

        public static bool isPlayingOrWillChangePlaymode => World.IsPlaying || EditorSession.StartsPlaying;

        internal static void AnnounceQuit() => quitting?.Invoke();

        internal static void Announce(PlayModeStateChange change) => playModeStateChanged?.Invoke(change);

        internal static void AnnounceHierarchyChange() => hierarchyChanged?.Invoke();

        internal static void AnnounceProjectChange() => projectChanged?.Invoke();

        internal static void RunDelayed()
        {
            CallbackFunction? due = delayCall;
            delayCall = null;
            due?.Invoke();
        }

        /// <summary>Removes all subscribers, as a domain reload does.</summary>
        internal static void Forget()
        {
            delayCall = null;
            update = null;
            quitting = null;
            hierarchyChanged = null;
            projectChanged = null;
            playModeStateChanged = null;
        }
    }

    public static partial class AssemblyReloadEvents
    {
        public delegate void AssemblyReloadCallback();

        public static event AssemblyReloadCallback? beforeAssemblyReload;

        internal static void Announce() => beforeAssemblyReload?.Invoke();

        internal static void Forget() => beforeAssemblyReload = null;
    }

    public partial struct ObjectChangeEventStream
    {
    }

    public static partial class ObjectChangeEvents
    {
        public delegate void ObjectChangeEventsHandler(ref ObjectChangeEventStream stream);

        public static event ObjectChangeEventsHandler? changesPublished;

        internal static void Publish()
        {
            var stream = default(ObjectChangeEventStream);
            changesPublished?.Invoke(ref stream);
        }

        internal static void Forget() => changesPublished = null;
    }

    [AttributeUsage(AttributeTargets.Method)]
    public partial class InitializeOnLoadMethodAttribute : Attribute
    {
    }

    public sealed partial class Selection
    {
        private static Object[] selected = Array.Empty<Object>();

        public static Action? selectionChanged;

        public static Object[] objects
        {
            get => selected;
            set
            {
                selected = value;
                selectionChanged?.Invoke();
            }
        }

        public static Object? activeObject
        {
            get => selected.Length > 0 ? selected[0] : null;
            set => objects = value == null ? Array.Empty<Object>() : new[] { value };
        }

        public static GameObject[] gameObjects => Array.ConvertAll(
            Array.FindAll(selected, each => each is GameObject && each != null), each => (GameObject)each);

        public static GameObject? activeGameObject
        {
            get => activeObject as GameObject;
            set => activeObject = value;
        }
    }

    public partial class EditorUtility
    {
        public static void SetDirty(Object target)
        {
        }

        public static bool IsPersistent(Object target) => AssetDatabase.GetAssetPath(target).Length > 0;
    }

    public enum SettingsScope
    {
        Project = 1,
    }

    [AttributeUsage(AttributeTargets.Method)]
    public sealed partial class SettingsProviderAttribute : Attribute
    {
    }

    public partial class SettingsProvider
    {
        public SettingsProvider(string path, SettingsScope scopes, IEnumerable<string>? keywords = null)
        {
            settingsPath = path;
            scope = scopes;
        }

        public string settingsPath { get; }
        public SettingsScope scope { get; }
        public Action<string>? guiHandler { get; set; }

        public virtual void OnGUI(string searchContext) => guiHandler?.Invoke(searchContext);
    }

    public static partial class SettingsService
    {
        public static EditorWindow? OpenProjectSettings(string? settingsPath = null)
        {
            EditorSession.OpenedSettings = settingsPath;
            return null;
        }
    }

    public sealed partial class PlayerSettings : Object
    {
        private static Object[] preloaded = Array.Empty<Object>();

        public static Object[] GetPreloadedAssets() => (Object[])preloaded.Clone();

        public static void SetPreloadedAssets(Object[] assets) => preloaded = (Object[])assets.Clone();
    }
}

namespace UnityEditor.SceneManagement
{
    public enum NewSceneMode
    {
        Single = 0,
    }

    public enum NewSceneSetup
    {
        EmptyScene = 0,
    }

    public sealed partial class EditorSceneManager : SceneManager
    {
        public static bool SaveCurrentModifiedScenesIfUserWantsTo() => !EditorSession.CancelsSaving;

        public static Scene NewScene(NewSceneSetup setup, NewSceneMode mode)
        {
            if (World.IsPlaying)
            {
                throw new InvalidOperationException("This cannot be used during play mode.");
            }
            if (setup != NewSceneSetup.EmptyScene || mode != NewSceneMode.Single)
            {
                throw new NotSupportedException("the shim opens empty scenes only, in place of the open one");
            }
            World.LoadEmptyScene();
            EditorSession.SceneIsDirty = false;
            return default;
        }

        public static bool MarkSceneDirty(Scene scene) => EditorSession.SceneIsDirty = true;
    }
}
