#nullable enable
using System.Collections.Generic;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Which surface a collider belongs to. Main thread; looking up makes no garbage.</summary>
    internal static class SurfaceRegistry
    {
        private static readonly Dictionary<Collider, HapticSurface> Surfaces =
            new Dictionary<Collider, HapticSurface>();

        public static void Add(Collider collider, HapticSurface surface) => Surfaces[collider] = surface;

        public static void Remove(Collider collider, HapticSurface surface)
        {
            if (Surfaces.TryGetValue(collider, out HapticSurface registered) && ReferenceEquals(registered, surface))
            {
                Surfaces.Remove(collider);
            }
        }

        public static bool TryFind(Collider collider, out HapticSurface surface) =>
            Surfaces.TryGetValue(collider, out surface!);

        /// <summary>The nearest surface at or above a transform.</summary>
        public static HapticSurface? OwnerOf(Transform place)
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
        private static void Forget() => Surfaces.Clear();
    }
}
