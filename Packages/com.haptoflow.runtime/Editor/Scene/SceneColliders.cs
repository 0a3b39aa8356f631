#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>Finds the colliders that can be felt and their surfaces in edit mode, in the same way as
    /// <see cref="HapticSurface"/> does in play mode.</summary>
    internal static class SceneColliders
    {
        /// <summary>Whether the collider is of a kind that a tip can feel.</summary>
        public static bool CanBeFelt(Collider collider) => !collider.isTrigger && ColliderProbe.IsSupportedKind(collider);

        /// <summary>The surface that a collider belongs to; null for an untagged collider.</summary>
        public static HapticSurface? SurfaceOf(Collider collider)
        {
            HapticSurface? owner = SurfaceRegistry.OwnerOf(collider.transform);
            bool isIncluded = owner != null &&
                (owner.IncludeChildren || ReferenceEquals(owner.gameObject, collider.gameObject));
            return isIncluded ? owner : null;
        }

        /// <summary>The colliders in the open scenes that can be felt, sorted by name.</summary>
        public static IReadOnlyList<Collider> InScenes() => Sorted(
            Object.FindObjectsByType<Collider>(FindObjectsInactive.Exclude, FindObjectsSortMode.None));

        /// <summary>The colliders on these objects and their children that can be felt, sorted by name.</summary>
        public static IReadOnlyList<Collider> Below(IEnumerable<GameObject> roots)
        {
            var all = new HashSet<Collider>();
            var here = new List<Collider>();
            foreach (GameObject root in roots)
            {
                root.GetComponentsInChildren(true, here);
                all.UnionWith(here);
            }
            return Sorted(all);
        }

        private static IReadOnlyList<Collider> Sorted(IEnumerable<Collider> colliders) => colliders
            .Where(collider => collider.enabled && CanBeFelt(collider))
            .OrderBy(collider => collider.name, System.StringComparer.Ordinal)
            .ToArray();
    }

    /// <summary>A subscription to changes of the open scenes and of the project, undo included.</summary>
    internal sealed class SceneChanges : IDisposable
    {
        private readonly Action changed;

        /// <summary>Subscribes. Dispose the object to unsubscribe.</summary>
        public SceneChanges(Action changed)
        {
            this.changed = changed;
            EditorApplication.hierarchyChanged += changed;
            EditorApplication.projectChanged += changed;
            ObjectChangeEvents.changesPublished += OnChangesPublished;
        }

        public void Dispose()
        {
            EditorApplication.hierarchyChanged -= changed;
            EditorApplication.projectChanged -= changed;
            ObjectChangeEvents.changesPublished -= OnChangesPublished;
        }

        private void OnChangesPublished(ref ObjectChangeEventStream stream) => changed();
    }

    /// <summary>Gives copies of surfaces in the open scenes seeds of their own. The surface that had a seed before keeps
    /// it; prefab assets are not searched.</summary>
    internal static class SurfaceSeedKeeper
    {
        // The seed of every surface of the open scenes, by instance, when it was last looked at.
        private static Dictionary<int, uint> known = new Dictionary<int, uint>();

        /// <summary>Looks for copies; for changes of the hierarchy outside of play mode.</summary>
        public static void Renew()
        {
            if (EditorApplication.isPlayingOrWillChangePlaymode)
            {
                return;
            }
            // Those that had their seed before come first, so that they keep it.
            HapticSurface[] surfaces = Object.FindObjectsByType<HapticSurface>(
                    FindObjectsInactive.Include, FindObjectsSortMode.InstanceID)
                .Where(surface => surface.Seed != 0).OrderByDescending(IsKnown).ToArray();
            var taken = new HashSet<uint>();
            foreach (HapticSurface surface in surfaces)
            {
                if (!taken.Add(surface.Seed))
                {
                    GiveNew(surface);
                    taken.Add(surface.Seed);
                }
            }
            known = surfaces.ToDictionary(surface => surface.GetInstanceID(), surface => surface.Seed);
        }

        private static bool IsKnown(HapticSurface surface) =>
            known.TryGetValue(surface.GetInstanceID(), out uint seed) && seed == surface.Seed;

        // Through the serialised field, so that overrides of prefabs, unsaved changes and undo know of it.
        private static void GiveNew(HapticSurface surface)
        {
            using var copy = new SerializedObject(surface);
            copy.FindProperty("seed").uintValue = SurfaceSeeds.New();
            copy.ApplyModifiedProperties();
        }
    }
}
