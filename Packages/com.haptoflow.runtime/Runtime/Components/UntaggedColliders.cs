#nullable enable
using System.Collections.Generic;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Colliders that were found to belong to no surface, so that furniture around a tip does not cost a walk
    /// through the hierarchy in every frame. Main thread; makes garbage only while it grows.</summary>
    internal sealed class UntaggedColliders
    {
        /// <summary>Number of look-ups for which an answer holds: a third of a second at 90 Hz.</summary>
        public const int Lookups = 30;

        // Beyond this number the answers are given up together; those that still matter are found again at once.
        private const int MaximumRemembered = 1024;
        private readonly Dictionary<Collider, int> remaining = new Dictionary<Collider, int>();

        /// <summary>True while an answer about the collider holds; counts the look-up.</summary>
        public bool Holds(Collider collider)
        {
            if (!remaining.TryGetValue(collider, out int left) || left == 0)
            {
                return false;
            }
            remaining[collider] = left - 1;
            return true;
        }

        public void Remember(Collider collider)
        {
            if (remaining.Count >= MaximumRemembered)
            {
                remaining.Clear();
            }
            remaining[collider] = Lookups;
        }

        public void Forget() => remaining.Clear();
    }
}
