#nullable enable
using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
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
            HapticSurface[] surfaces = Object.FindObjectsByType<HapticSurface>(
                FindObjectsInactive.Include, FindObjectsSortMode.InstanceID);
            var taken = new HashSet<uint>();
            var now = new Dictionary<int, uint>();
            foreach (HapticSurface surface in surfaces)
            {
                if (IsKnown(surface) && taken.Add(surface.Seed))
                {
                    now.Add(surface.GetInstanceID(), surface.Seed);
                }
            }
            foreach (HapticSurface surface in surfaces)
            {
                if (surface.Seed != 0 && !now.ContainsKey(surface.GetInstanceID()))
                {
                    if (!taken.Add(surface.Seed))
                    {
                        GiveNew(surface);
                        taken.Add(surface.Seed);
                    }
                    now.Add(surface.GetInstanceID(), surface.Seed);
                }
            }
            known = now;
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
