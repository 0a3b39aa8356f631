#nullable enable
using System;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.SceneManagement;
using Object = UnityEngine.Object;

namespace HaptoFlow
{
    /// <summary>Maps colliders to surfaces. Main thread; a look-up makes no garbage.</summary>
    internal static class SurfaceRegistry
    {
        private static readonly ObjectCache<Collider, HapticSurface> Surfaces =
            new ObjectCache<Collider, HapticSurface>();

        private static readonly UntaggedColliders Untagged = new UntaggedColliders();

        public static int Count => Surfaces.Count;

        /// <summary>Registers a collider, and takes it from the surface that had it.</summary>
        public static void Add(Collider collider, HapticSurface surface)
        {
            if (Surfaces.TryGetValue(collider, out HapticSurface before) && !ReferenceEquals(before, surface))
            {
                before.Disown(collider);
            }
            Surfaces.Set(collider, surface);
        }

        public static void Remove(Collider collider, HapticSurface surface)
        {
            if (IsOf(collider, surface))
            {
                Surfaces.Remove(collider);
            }
        }

        public static bool IsOf(Collider collider, HapticSurface surface) =>
            Surfaces.TryGetValue(collider, out HapticSurface registered) && ReferenceEquals(registered, surface);

        /// <summary>Registers the learnt materials of all surfaces before they are touched.</summary>
        public static void PrepareAll(HapticSession session)
        {
            foreach (HapticSurface surface in Surfaces.Values)
            {
                session.Prepare(surface.SharedDescription);
                session.Prepare(surface.Relief);
            }
        }

        /// <summary>True where the collider still belongs to the surface that was looked up for it.</summary>
        public static bool Holds(Collider collider, HapticSurface surface) =>
            IsOf(collider, surface) && surface.Keeps(collider);

        /// <summary>Has colliders of no surface searched again: a surface came, changed or moved.</summary>
        public static void Changed() => Untagged.Forget();

        /// <summary>Finds the surface of a collider by the collider's present place in the hierarchy, so that colliders
        /// added or moved since the last search are found. Null for an untagged collider, which is remembered for
        /// <see cref="UntaggedColliders.Lookups"/> look-ups: Unity does not report a move deep in the hierarchy.
        /// </summary>
        public static HapticSurface? Resolve(Collider collider)
        {
            if (Untagged.Holds(collider))
            {
                return null;
            }
            HapticSurface? owner = OwnerOf(collider.transform);
            if (owner == null || !owner.isActiveAndEnabled || !owner.Reaches(collider))
            {
                if (Surfaces.TryGetValue(collider, out HapticSurface before))
                {
                    before.Disown(collider);
                    Surfaces.Remove(collider);
                }
                Untagged.Remember(collider);
                return null;
            }
            owner.Adopt(collider);
            return owner;
        }

        public static HapticSurface? OwnerOf(Transform? place)
        {
            for (Transform? each = place; each != null; each = each.parent)
            {
                if (each.TryGetComponent(out HapticSurface surface))
                {
                    return surface;
                }
            }
            return null;
        }

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Forget()
        {
            Surfaces.Clear();
            Untagged.Forget();
        }
    }

    /// <summary>Colliders that were found to belong to no surface, so that furniture around a tip does not cost a walk
    /// through the hierarchy in every frame. Main thread; makes garbage only while it grows.</summary>
    internal sealed class UntaggedColliders
    {
        /// <summary>Number of look-ups for which an answer holds: a third of a second at 90 Hz.</summary>
        public const int Lookups = 30;

        // Beyond this number the answers are given up together; those that still matter are found again at once.
        private const int MaximumRemembered = 1024;
        private readonly Dictionary<Collider, int> remaining = new Dictionary<Collider, int>();

        /// <summary>True while an answer about the collider holds; counts the look-up.</summary>
        public bool Holds(Collider collider)
        {
            if (!remaining.TryGetValue(collider, out int left) || left == 0)
            {
                return false;
            }
            remaining[collider] = left - 1;
            return true;
        }

        public void Remember(Collider collider)
        {
            if (remaining.Count >= MaximumRemembered)
            {
                remaining.Clear();
            }
            remaining[collider] = Lookups;
        }

        public void Forget() => remaining.Clear();
    }

    /// <summary>The numbers that name surfaces to the engine: surfaces with different numbers have their asperities at
    /// different places.</summary>
    internal static class SurfaceSeeds
    {
        private static readonly List<GameObject> Roots = new List<GameObject>();

        /// <summary>The number of a collider: its surface's, changed by the way from the collider up to the surface, so
        /// that parts with frames of their own differ. Without a number of the surface, and without a surface, the
        /// way up to the scene. Main thread, no garbage.</summary>
        public static uint Of(Collider collider, HapticSurface? surface)
        {
            bool hasNumber = surface is object && surface.Seed != 0;
            Transform? top = hasNumber ? surface!.transform : null;
            uint number = hasNumber ? surface!.Seed : unchecked((uint)collider.gameObject.scene.buildIndex);
            for (Transform? place = collider.transform; !ReferenceEquals(place, top) && place is object;
                 place = place.parent)
            {
                number = Mixed(unchecked(number + (uint)IndexOf(place)));
            }
            return number;
        }

        // In a player, GetSiblingIndex is 0 for every object without a parent.
        private static int IndexOf(Transform place)
        {
            if (place.parent is object)
            {
                return place.GetSiblingIndex();
            }
            GameObject root = place.gameObject;
            root.scene.GetRootGameObjects(Roots);
            int index = Roots.IndexOf(root);
            Roots.Clear();
            return index;
        }

        /// <summary>A random number other than 0. It leaves UnityEngine.Random as it is.</summary>
        public static uint New()
        {
            uint number = 0;
            while (number == 0)
            {
                number = unchecked((uint)Guid.NewGuid().GetHashCode());
            }
            return number;
        }

        // Surfaces with neighbouring numbers get unlike seeds, and no two the same one: each bit of the result depends on
        // all bits of the number (the finaliser of MurmurHash3). The step before it keeps 0 from giving 0.
        private static uint Mixed(uint number)
        {
            unchecked
            {
                number += 0x9E3779B9u;
                number = (number ^ (number >> 16)) * 0x85EBCA6Bu;
                number = (number ^ (number >> 13)) * 0xC2B2AE35u;
                return number ^ (number >> 16);
            }
        }
    }

    /// <summary>Values by Unity objects. Destroyed objects are removed whenever the number of entries has doubled, so a
    /// scene that spawns for hours keeps at most twice what lives in it. Main thread; makes garbage only while it
    /// grows.</summary>
    internal sealed class ObjectCache<TKey, TValue>
        where TKey : Object
    {
        private const int MinimumBeforeSweep = 256;
        private readonly Dictionary<TKey, TValue> entries = new Dictionary<TKey, TValue>();
        private readonly List<TKey> gone = new List<TKey>();
        private int sweepAt = MinimumBeforeSweep;

        public int Count => entries.Count;

        public Dictionary<TKey, TValue>.ValueCollection Values => entries.Values;

        public bool TryGetValue(TKey key, out TValue value) => entries.TryGetValue(key, out value!);

        public void Set(TKey key, TValue value)
        {
            if (entries.Count >= sweepAt && !entries.ContainsKey(key))
            {
                Sweep();
            }
            entries[key] = value;
        }

        public void Remove(TKey key) => entries.Remove(key);

        public void Clear()
        {
            entries.Clear();
            sweepAt = MinimumBeforeSweep;
        }

        /// <summary>Forgets everything when play mode begins; from then on, whatever a scene unloads.</summary>
        public void Begin()
        {
            Clear();
            SceneManager.sceneUnloaded -= OnSceneUnloaded;
            SceneManager.sceneUnloaded += OnSceneUnloaded;
        }

        /// <summary>Removes destroyed objects now. What values reference, such as meshes, Unity cannot unload
        /// before.</summary>
        public void Sweep()
        {
            foreach (TKey key in entries.Keys)
            {
                if (key == null)
                {
                    gone.Add(key!);
                }
            }
            foreach (TKey key in gone)
            {
                entries.Remove(key);
            }
            gone.Clear();
            sweepAt = Math.Max(MinimumBeforeSweep, 2 * entries.Count);
        }

        private void OnSceneUnloaded(Scene scene) => Sweep();
    }
}
