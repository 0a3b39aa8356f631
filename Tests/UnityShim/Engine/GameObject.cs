using System;
using System.Collections.Generic;
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

    public sealed partial class GameObject : Object
    {
        internal readonly List<Component> Components = new List<Component>();
        private bool active = true;

        public GameObject()
            : this("New Game Object")
        {
        }

        public GameObject(string name)
        {
            World.RequireMainThread();
            this.name = name;
            transform = new Transform();
            transform.Attach(this);
            Components.Add(transform);
            World.Add(this);
        }

        public Transform transform { get; }
        public int layer { get; set; }
        public bool activeSelf => active;
        public bool activeInHierarchy => active && (transform.parent == null || transform.parent.gameObject.activeInHierarchy);

        public void SetActive(bool value)
        {
            active = value;
            World.RefreshActivity(this);
        }

        public T AddComponent<T>()
            where T : Component => (T)World.AddComponent(this, typeof(T));

        public T GetComponent<T>() => TryGetComponent(out T component) ? component : default!;

        public bool TryGetComponent<T>(out T component)
        {
            ++ComponentSearchCount<T>.Searches;
            foreach (Component each in Components)
            {
                if (each is T found)
                {
                    component = found;
                    return true;
                }
            }
            component = default!;
            return false;
        }

        public void GetComponents<T>(List<T> results)
        {
            results.Clear();
            AddComponentsTo(results);
        }

        /// <summary>The component of this object, else that of the nearest parent with one.</summary>
        public T GetComponentInParent<T>(bool includeInactive)
        {
            for (Transform? place = transform; place is object; place = place.parent)
            {
                if ((includeInactive || place.gameObject.activeInHierarchy) && place.TryGetComponent(out T component))
                {
                    return component;
                }
            }
            return default!;
        }

        /// <summary>The component of this object, else that of the first child with one.</summary>
        public T GetComponentInChildren<T>(bool includeInactive)
        {
            var found = new List<T>();
            GetComponentsInChildren(includeInactive, found);
            return found.Count > 0 ? found[0] : default!;
        }

        public void GetComponentsInChildren<T>(bool includeInactive, List<T> results)
        {
            results.Clear();
            AddFromChildren(includeInactive, results);
        }

        private void AddFromChildren<T>(bool includeInactive, List<T> result)
        {
            if (!includeInactive && !activeInHierarchy)
            {
                return;
            }
            AddComponentsTo(result);
            foreach (Transform child in transform.Children)
            {
                child.gameObject.AddFromChildren(includeInactive, result);
            }
        }

        private void AddComponentsTo<T>(List<T> results)
        {
            foreach (Component each in Components)
            {
                if (each is T found)
                {
                    results.Add(found);
                }
            }
        }
    }

    public class Component : Object
    {
        private GameObject owner = null!;

        internal override Object Named => owner;

        public GameObject gameObject => owner;
        public Transform transform => owner.transform;

        public T GetComponent<T>() => owner.GetComponent<T>();
        public bool TryGetComponent<T>(out T component) => owner.TryGetComponent(out component);
        public void GetComponents<T>(List<T> results) => owner.GetComponents(results);
        public void GetComponentsInChildren<T>(bool includeInactive, List<T> result) =>
            owner.GetComponentsInChildren(includeInactive, result);

        public T GetComponentInParent<T>(bool includeInactive) => owner.GetComponentInParent<T>(includeInactive);
        public T GetComponentInChildren<T>(bool includeInactive) => owner.GetComponentInChildren<T>(includeInactive);

        public void SendMessage(string methodName, object value) => Messages.SendByName(owner, methodName, value);

        internal void Attach(GameObject gameObject) => owner = gameObject;
    }

    public class Behaviour : Component
    {
        private bool switchedOn = true;

        public bool enabled
        {
            get => switchedOn;
            set
            {
                switchedOn = value;
                World.RefreshActivity(gameObject);
            }
        }

        public bool isActiveAndEnabled => switchedOn && !IsDestroyed && gameObject.activeInHierarchy;
    }

    public class MonoBehaviour : Behaviour
    {
    }

    public class Transform : Component
    {
        internal readonly List<Transform> Children = new List<Transform>();
        private Transform? above;

        protected internal Transform()
        {
        }

        public Vector3 localPosition { get; set; }
        public Quaternion localRotation { get; set; } = Quaternion.identity;
        public Vector3 localScale { get; set; } = Vector3.one;

        public Transform? parent
        {
            get => above;
            set => SetParent(value, true);
        }

        public Vector3 position
        {
            get => above == null ? localPosition : above.TransformPoint(localPosition);
            set => localPosition = above == null ? value : above.InverseTransformPoint(value);
        }

        public Quaternion rotation
        {
            get => above == null ? localRotation : above.rotation * localRotation;
            set => localRotation = above == null ? value : Quaternion.Inverse(above.rotation) * value;
        }

        /// <summary>Correct unless a rotated child below a non-uniform scale is sheared.</summary>
        public Transform root => above == null ? this : above.root;

        public Vector3 lossyScale => above == null ? localScale : Vector3.Scale(above.lossyScale, localScale);

        public void SetParent(Transform? parent, bool worldPositionStays)
        {
            Vector3 place = position;
            Quaternion turned = rotation;
            Transform? before = above;
            above?.Children.Remove(this);
            above = parent;
            above?.Children.Add(this);
            UnityShim.World.SendChildrenChanged(before);
            UnityShim.World.SendChildrenChanged(above);
            if (worldPositionStays)
            {
                SetPositionAndRotation(place, turned);
            }
            UnityShim.World.RefreshActivity(gameObject);
        }

        /// <summary>True for the transform itself, as in Unity.</summary>
        public bool IsChildOf(Transform parent) =>
            ReferenceEquals(this, parent) || (above != null && above.IsChildOf(parent));

        public int childCount => Children.Count;

        public Transform GetChild(int index) => Children[index];

        public int GetSiblingIndex() => above is object
            ? above.Children.IndexOf(this)
            : UnityShim.World.RootIndexOf(gameObject);

        public Transform? Find(string n) => Children.Find(child => child.name == n);

        public void SetPositionAndRotation(Vector3 position, Quaternion rotation)
        {
            this.position = position;
            this.rotation = rotation;
        }

        public void GetPositionAndRotation(out Vector3 position, out Quaternion rotation)
        {
            position = this.position;
            rotation = this.rotation;
        }

        public Vector3 TransformPoint(Vector3 position) => this.position + rotation * Vector3.Scale(lossyScale, position);

        public Vector3 InverseTransformPoint(Vector3 position)
        {
            Vector3 turned = Quaternion.Inverse(rotation) * (position - this.position);
            Vector3 scale = lossyScale;
            return new Vector3(turned.x / scale.x, turned.y / scale.y, turned.z / scale.z);
        }

        public Vector3 TransformDirection(Vector3 direction) => rotation * direction;
    }
}
