#nullable enable
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Maps colliders to surfaces. Main thread; a look-up makes no garbage.</summary>
    internal static class SurfaceRegistry
    {
        private static readonly ObjectCache<Collider, HapticSurface> Surfaces =
            new ObjectCache<Collider, HapticSurface>();

        private static readonly UntaggedColliders Untagged = new UntaggedColliders();

        /// <summary>The number of registered colliders, with the destroyed ones that are not swept yet.</summary>
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

        /// <summary>True where the collider is registered for the surface.</summary>
        public static bool IsOf(Collider collider, HapticSurface surface) =>
            Surfaces.TryGetValue(collider, out HapticSurface registered) && ReferenceEquals(registered, surface);

        /// <summary>Registers the learnt materials of all surfaces before they are touched.</summary>
        public static void PrepareAll(HapticSession session)
        {
            foreach (HapticSurface surface in Surfaces.Values)
            {
                session.Prepare(surface.SharedDescription);
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
        private static void Forget()
        {
            Surfaces.Clear();
            Untagged.Forget();
        }
    }
}
