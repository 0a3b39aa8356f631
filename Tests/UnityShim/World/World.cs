using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using System.Threading;
using UnityEngine;
using Object = UnityEngine.Object;

namespace UnityShim
{
    /// <summary>A Unity player with objects, frames and play mode, driven by tests.</summary>
    public static class World
    {
        private static readonly List<GameObject> Objects = new List<GameObject>();
        private static readonly List<ScriptState> Scripts = new List<ScriptState>();
        private static readonly List<Object> Condemned = new List<Object>();
        private static readonly HashSet<Object> Kept = new HashSet<Object>();
        private static readonly Dictionary<string, Object> ResourceAssets = new Dictionary<string, Object>();
        private static int instances;
        private static Thread? mainThread;

        /// <summary>The platform that Unity reports.</summary>
        internal static RuntimePlatform Platform { get; set; } = RuntimePlatform.LinuxEditor;

        public static bool IsPlaying { get; private set; }

        /// <summary>The address that was opened last in the system's browser.</summary>
        public static string? OpenedUrl { get; internal set; }

        public static event Action? Quitting;

        /// <summary>The frame rate of <see cref="Frame()"/>.</summary>
        public static double FrameRateHz { get; set; } = 90.0;

        /// <summary>Enters play mode with an empty scene: clocks at zero, the audio device at 48 kHz, load methods
        /// called. Static fields keep their values, as with domain reload off, so scripts have to reset their own.
        /// </summary>
        public static void EnterPlayMode()
        {
            mainThread = Thread.CurrentThread;
            Clock.Reset();
            FrameRateHz = 90.0;
            AudioDevice.Reset();
            Log.Clear();
            IsPlaying = true;
            CallLoadMethods();
            WakeScripts();
        }

        /// <summary>Opens an editor with an empty scene. Scripts receive no messages before play mode.</summary>
        public static void BeginEditing()
        {
            mainThread = Thread.CurrentThread;
            DestroyAll(true);
            Log.Clear();
            IsPlaying = false;
        }

        /// <summary>Raises the quitting event, then destroys all objects.</summary>
        public static void ExitPlayMode()
        {
            Quitting?.Invoke();
            DestroyAll(true);
            ResourceAssets.Clear();
            IsPlaying = false;
        }

        /// <summary>Destroys the objects of the scene, except those that are kept across scenes.</summary>
        public static void LoadEmptyScene()
        {
            DestroyAll(false);
            UnityEngine.SceneManagement.SceneManager.AnnounceUnloaded(default);
        }

        public static void Frame() => Frame(1.0 / FrameRateHz);

        public static void Frame(double seconds)
        {
            Clock.NextFrame(seconds);
            Send(Message.Start);
            while (Clock.NextFixedStep())
            {
                Clock.InFixedStep = true;
                Send(Message.FixedUpdate);
                PhysicsWorld.Step();
                Clock.InFixedStep = false;
            }
            PhysicsWorld.ShowBodies();
            Send(Message.Update);
            Send(Message.LateUpdate);
            DestroyCondemned();
            AudioDevice.Advance(seconds);
        }

        public static void Frames(int count)
        {
            for (int index = 0; index < count; ++index)
            {
                Frame();
            }
        }

        /// <summary>Adds an asset that Resources.Load finds.</summary>
        public static void AddResource(string path, Object asset) => ResourceAssets[path] = asset;

        internal static IReadOnlyList<GameObject> AllObjects => Objects;

        internal static IReadOnlyList<ScriptState> AllScripts => Scripts;

        internal static int NextInstance() => Interlocked.Increment(ref instances);

        internal static Object? Resource(string path) => ResourceAssets.TryGetValue(path, out Object? asset) ? asset : null;

        internal static int RootIndexOf(GameObject root)
        {
            int index = 0;
            foreach (GameObject each in Objects)
            {
                if (ReferenceEquals(each, root))
                {
                    break;
                }
                index += each.transform.parent is null && each.scene == root.scene ? 1 : 0;
            }
            return index;
        }

        internal static void Add(GameObject gameObject) => Objects.Add(gameObject);

        internal static void KeepOverSceneLoads(Object target) => Kept.Add(target);

        /// <exception cref="InvalidOperationException">Called from another thread than the main thread, as in Unity.
        /// </exception>
        internal static void RequireMainThread()
        {
            if (mainThread != null && Thread.CurrentThread != mainThread)
            {
                throw new InvalidOperationException("can only be called from the main thread");
            }
        }

        internal static Component AddComponent(GameObject owner, Type type)
        {
            RequireMainThread();
            AddRequired(owner, type);
            var component = (Component)Activator.CreateInstance(type)!;
            component.Attach(owner);
            owner.Components.Add(component);
            PhysicsWorld.Added(component);
            if (component is AudioSource source)
            {
                source.Playing = source.playOnAwake;
            }
            if (component is MonoBehaviour script)
            {
                var state = new ScriptState(script);
                int place = Scripts.FindLastIndex(each => each.Order <= state.Order) + 1;
                Scripts.Insert(place, state);
                if (!IsPlaying)
                {
                    Messages.Reset(script);
                }
                state.Refresh();
            }
            return component;
        }

        private static void AddRequired(GameObject owner, Type type)
        {
            foreach (RequireComponent required in type.GetCustomAttributes<RequireComponent>())
            {
                if (!owner.Components.Exists(required.m_Type0.IsInstanceOfType))
                {
                    AddComponent(owner, required.m_Type0);
                }
            }
        }

        internal static T[] Find<T>(bool alsoInactive)
            where T : Object => Objects
            .Where(each => alsoInactive || each.activeInHierarchy)
            .SelectMany(each => each.Components.OfType<T>())
            .ToArray();

        internal static void RefreshActivity(GameObject changed)
        {
            foreach (ScriptState state in Scripts.Where(state => IsBelow(state.Script.transform, changed.transform)).ToList())
            {
                state.Refresh();
            }
        }

        /// <summary>Finds direct children only, as in Unity.</summary>
        internal static void SendChildrenChanged(Transform? parent)
        {
            if (parent == null)
            {
                return;
            }
            foreach (ScriptState state in Scripts.Where(state => state.Script.transform == parent).ToList())
            {
                state.Send(Message.OnTransformChildrenChanged);
            }
        }

        internal static void DestroyLater(Object condemned)
        {
            if (condemned != null)
            {
                Condemned.Add(condemned);
            }
        }

        internal static void DestroyNow(Object condemned)
        {
            RequireMainThread();
            if (condemned == null)
            {
                return;
            }
            if (condemned is GameObject gameObject)
            {
                DestroyTree(gameObject);
                return;
            }
            if (condemned is Component component)
            {
                EndScript(component);
                component.gameObject.Components.Remove(component);
                PhysicsWorld.Removed(component);
            }
            if (condemned is ScriptableObject script && !(condemned is UnityEditor.EditorWindow))
            {
                Messages.Of(script).Send(Message.OnDisable);
                Messages.Of(script).Send(Message.OnDestroy);
            }
            condemned.MarkDestroyed();
        }

        private static void DestroyTree(GameObject gameObject)
        {
            foreach (Transform child in gameObject.transform.Children.ToList())
            {
                DestroyTree(child.gameObject);
            }
            foreach (Component component in gameObject.Components.ToList())
            {
                EndScript(component);
            }
            foreach (Component component in gameObject.Components)
            {
                PhysicsWorld.Removed(component);
                component.MarkDestroyed();
            }
            Transform? above = gameObject.transform.parent;
            above?.Children.Remove(gameObject.transform);
            Objects.Remove(gameObject);
            Kept.Remove(gameObject);
            gameObject.MarkDestroyed();
            SendChildrenChanged(above);
        }

        private static void EndScript(Component component)
        {
            int index = Scripts.FindIndex(state => ReferenceEquals(state.Script, component));
            if (index >= 0)
            {
                ScriptState state = Scripts[index];
                state.End();
                Scripts.Remove(state);
            }
        }

        private static void DestroyAll(bool alsoKept)
        {
            foreach (GameObject gameObject in Objects.Where(each => each.transform.parent == null).ToList())
            {
                if (alsoKept || !Kept.Contains(gameObject))
                {
                    DestroyNow(gameObject);
                }
            }
            Condemned.Clear();
        }

        private static void DestroyCondemned()
        {
            for (int index = 0; index < Condemned.Count; ++index)
            {
                DestroyNow(Condemned[index]);
            }
            Condemned.Clear();
        }

        private static void Send(Message message)
        {
            for (int index = 0; index < Scripts.Count; ++index)
            {
                Scripts[index].Send(message);
            }
        }

        private static bool IsBelow(Transform candidate, Transform root)
        {
            for (Transform? place = candidate; place is not null; place = place.parent)
            {
                if (ReferenceEquals(place, root))
                {
                    return true;
                }
            }
            return false;
        }

        private static void WakeScripts()
        {
            foreach (ScriptState state in Scripts.ToList())
            {
                state.Refresh();
            }
        }

        private static void CallLoadMethods()
        {
            const BindingFlags anyStatic = BindingFlags.Static | BindingFlags.Public | BindingFlags.NonPublic;
            var methods = AppDomain.CurrentDomain.GetAssemblies()
                .Where(assembly => assembly.GetName().Name!.StartsWith("HaptoFlow", StringComparison.Ordinal))
                .SelectMany(assembly => assembly.GetTypes())
                .SelectMany(type => type.GetMethods(anyStatic))
                .Select(method => (method, load: method.GetCustomAttribute<RuntimeInitializeOnLoadMethodAttribute>()))
                .Where(entry => entry.load != null)
                .OrderByDescending(entry => entry.load!.loadType);
            foreach ((MethodInfo method, _) in methods)
            {
                method.Invoke(null, null);
            }
        }
    }
}
