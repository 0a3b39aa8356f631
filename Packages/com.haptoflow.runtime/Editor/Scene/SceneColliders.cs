#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEngine;

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
}
