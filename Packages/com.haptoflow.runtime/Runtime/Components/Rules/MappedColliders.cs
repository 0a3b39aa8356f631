#nullable enable
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.SceneManagement;

namespace HaptoFlow
{
    /// <summary>Caches the materials that the maps assign to colliders without a surface. Main thread; no garbage for a
    /// known collider that has not changed.</summary>
    internal static class MappedColliders
    {
        private static readonly ObjectCache<Collider, MappedCollider> Known = new ObjectCache<Collider, MappedCollider>();
        private static readonly List<HapticMaterialMap> Maps = new List<HapticMaterialMap>();

        /// <summary>Number of cached colliders.</summary>
        public static int Count => Known.Count;

        /// <summary>Null where no rule assigns a material to the collider.</summary>
        public static MappedCollider? Resolve(Collider collider)
        {
            if (!MaterialMaps.Any)
            {
                return null;
            }
            if (!Known.TryGetValue(collider, out MappedCollider felt))
            {
                MaterialMaps.CollectFor(collider.gameObject.scene, Maps);
                felt = new MappedCollider(collider, Maps) { MapsVersion = MaterialMaps.Version };
                Known.Set(collider, felt);
            }
            else if (felt.MapsVersion != MaterialMaps.Version || !felt.IsUpToDate())
            {
                MaterialMaps.CollectFor(collider.gameObject.scene, Maps);
                felt.Renew(Maps);
                felt.MapsVersion = MaterialMaps.Version;
            }
            return felt.CanBeFelt ? felt : null;
        }

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Forget()
        {
            Known.Clear();
            SceneManager.sceneUnloaded -= OnSceneUnloaded;
            SceneManager.sceneUnloaded += OnSceneUnloaded;
        }

        private static void OnSceneUnloaded(Scene scene) => Known.Sweep();
    }
}
