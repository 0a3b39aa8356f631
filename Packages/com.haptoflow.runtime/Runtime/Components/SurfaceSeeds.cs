#nullable enable
using System;
using System.Collections.Generic;
using UnityEngine;

namespace HaptoFlow
{
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

        // A bijection of 32 bits in which every bit depends on every other (the finaliser of MurmurHash3), after a step
        // that keeps 0 from being mapped to itself.
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
}
