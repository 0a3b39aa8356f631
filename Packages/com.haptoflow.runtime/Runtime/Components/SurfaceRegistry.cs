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

        /// <summary>Has what the surfaces are made of registered before they are touched.</summary>
        public static void PrepareAll(HapticSession session)
        {
            foreach (HapticSurface surface in Surfaces.Values)
            {
                session.Prepare(surface.SharedDescription);
            }
        }

        /// <summary>The collider still leads to the surface as when it was last looked up.</summary>
        public static bool Holds(Collider collider, HapticSurface surface) =>
            Surfaces.TryGetValue(collider, out HapticSurface registered) && ReferenceEquals(registered, surface) &&
            surface.Keeps(collider);

        /// <summary>The surface that feels a collider, by where the collider is in the hierarchy now: also one that was
        /// added, or moved below another parent, since anybody looked. Null for an untagged one.</summary>
        public static HapticSurface? Resolve(Collider collider)
        {
            HapticSurface? owner = OwnerOf(collider.transform);
            if (owner == null || !owner.isActiveAndEnabled || !owner.Reaches(collider))
            {
                Surfaces.Remove(collider);
                return null;
            }
            owner.Adopt(collider);
            return owner;
        }

        /// <summary>The nearest surface at or above a transform.</summary>
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
        private static void Forget() => Surfaces.Clear();
    }
}
