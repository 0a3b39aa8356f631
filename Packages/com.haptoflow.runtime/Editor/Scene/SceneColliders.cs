#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>What the editor says of colliders before play mode has registered any: by the rules that
    /// <see cref="HapticSurface"/> goes by.</summary>
    internal static class SceneColliders
    {
        /// <summary>A kind of collider that a tip can feel.</summary>
        public static bool CanBeFelt(Collider collider) => !collider.isTrigger && ColliderProbe.IsSupportedKind(collider);

        /// <summary>The surface whose material the collider has; null for an untagged one.</summary>
        public static HapticSurface? SurfaceOf(Collider collider)
        {
            HapticSurface? owner = SurfaceRegistry.OwnerOf(collider.transform);
            bool reached = owner != null &&
                (owner.IncludeChildren || ReferenceEquals(owner.gameObject, collider.gameObject));
            return reached ? owner : null;
        }

        /// <summary>Everything that could be felt in the open scenes, by name.</summary>
        public static IReadOnlyList<Collider> InScenes() => Sorted(
            Object.FindObjectsByType<Collider>(FindObjectsInactive.Exclude, FindObjectsSortMode.None));

        /// <summary>Everything that could be felt on these objects and below them, by name.</summary>
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
