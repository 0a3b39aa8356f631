using System;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

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

        public static bool isPlaying
        {
            get => World.IsPlaying;
            set => throw new NotSupportedException("tests call EditorSession.Play and EditorSession.Stop");
        }

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
}
