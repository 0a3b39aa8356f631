using System;
using System.Collections.Generic;
using UnityShim;

namespace UnityEngine
{
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
        public bool CompareTag(string tag) => owner.CompareTag(tag);

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
}
