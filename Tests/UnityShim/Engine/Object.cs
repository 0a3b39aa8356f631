using System;
using UnityShim;

namespace UnityEngine
{
    public class Object
    {
        private readonly int instance = World.NextInstance();
        private string text = "";

        /// <summary>The object whose name this one shows: components show that of their GameObject.</summary>
        internal virtual Object Named => this;

        internal bool IsDestroyed { get; private set; }

        /// <summary>Reading it allocates, as in Unity.</summary>
        public string name
        {
            get => new string(Named.text.AsSpan());
            set => Named.text = value;
        }

        public HideFlags hideFlags { get; set; }

        public int GetInstanceID() => instance;

        public static implicit operator bool(Object? exists) => !IsNull(exists);
        public static bool operator ==(Object? x, Object? y) => IsNull(x) ? IsNull(y) : ReferenceEquals(x, y);
        public static bool operator !=(Object? x, Object? y) => !(x == y);

        public override bool Equals(object? other) => other is Object that ? this == that : other == null && IsDestroyed;
        public override int GetHashCode() => instance;
        public override string ToString() => name + " (" + GetType().FullName + ")";

        /// <summary>Destroys the object at the end of the frame.</summary>
        public static void Destroy(Object obj) => World.DestroyLater(obj);

        public static void DestroyImmediate(Object obj) => World.DestroyNow(obj);

        public static void DestroyImmediate(Object obj, bool allowDestroyingAssets) => World.DestroyNow(obj);

        public static T[] FindObjectsByType<T>(FindObjectsInactive findObjectsInactive, FindObjectsSortMode sortMode)
            where T : Object => World.Find<T>(findObjectsInactive == FindObjectsInactive.Include);

        public static void DontDestroyOnLoad(Object target) => World.KeepOverSceneLoads(target);

        internal void MarkDestroyed() => IsDestroyed = true;

        private static bool IsNull(Object? candidate) => candidate is null || candidate.IsDestroyed;
    }

    public class ScriptableObject : Object
    {
        public static T CreateInstance<T>()
            where T : ScriptableObject => (T)CreateInstance(typeof(T));

        public static ScriptableObject CreateInstance(Type type)
        {
            var instance = (ScriptableObject)Activator.CreateInstance(type)!;
            Messages.Of(instance).Send(Message.OnEnable);
            return instance;
        }
    }
}
