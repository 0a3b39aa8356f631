#nullable enable
using System;
using System.Collections.Generic;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Caches the materials that the maps assign to colliders without a surface. Main thread; no garbage for a
    /// known collider that has not changed.</summary>
    internal static class MappedColliders
    {
        private const int MinimumBeforeSweep = 256;
        private static readonly Dictionary<Collider, MappedCollider> Known = new Dictionary<Collider, MappedCollider>();
        private static readonly List<HapticMaterialMap> Maps = new List<HapticMaterialMap>();
        private static readonly List<Collider> Gone = new List<Collider>();
        private static int sweepAt = MinimumBeforeSweep;

        /// <summary>Number of cached colliders.</summary>
        public static int Count => Known.Count;

        /// <summary>Null where no rule assigns a material to the collider.</summary>
        public static MappedCollider? Resolve(Collider collider)
        {
            if (!MaterialMaps.Any)
            {
                return null;
            }
            if (!Known.TryGetValue(collider, out MappedCollider? felt))
            {
                Sweep();
                MaterialMaps.CollectFor(collider.gameObject.scene, Maps);
                felt = new MappedCollider(collider, Maps) { MapsVersion = MaterialMaps.Version };
                Known.Add(collider, felt);
            }
            else if (felt.MapsVersion != MaterialMaps.Version || !felt.IsUpToDate())
            {
                MaterialMaps.CollectFor(collider.gameObject.scene, Maps);
                felt.Renew(Maps);
                felt.MapsVersion = MaterialMaps.Version;
            }
            return felt.CanBeFelt ? felt : null;
        }

        /// <summary>Removes destroyed colliders whenever the cache has doubled.</summary>
        private static void Sweep()
        {
            if (Known.Count < sweepAt)
            {
                return;
            }
            foreach (KeyValuePair<Collider, MappedCollider> entry in Known)
            {
                if (entry.Key == null)
                {
                    Gone.Add(entry.Key!);
                }
            }
            foreach (Collider collider in Gone)
            {
                Known.Remove(collider);
            }
            Gone.Clear();
            sweepAt = Math.Max(MinimumBeforeSweep, 2 * Known.Count);
        }

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Forget()
        {
            Known.Clear();
            sweepAt = MinimumBeforeSweep;
        }
    }
}
