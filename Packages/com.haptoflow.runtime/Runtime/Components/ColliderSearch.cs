#nullable enable
using System;
using HaptoFlow.Numerics;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>The colliders around a tip, where they are drawn. Main thread, no garbage.</summary>
    /// <remarks>The physics engine holds what moves where it was in the last step, or will be in the next: at 20 m/s
    /// four decimetres away from where it is drawn. What rides along with a tip is found along the tip's own way, as far
    /// back and ahead as a step and a frame. After a shift of the world it is still where the tip was before.</remarks>
    internal sealed class ColliderSearch
    {
        private const int MaximumColliders = 128;

        // A way that is shorter is within the margin of the search.
        private const double ShortWayMetres = 0.02;

        // A longer way in one frame is a shift of the world or a teleport.
        private const double LongestWayMetres = 30.0;

        private const double LongestStepSeconds = 0.25;

        private readonly Collider[] colliders = new Collider[MaximumColliders];
        private Double3 way;
        private Double3 previousTipMetres;
        private double previousSeconds;
        private bool hasPrevious;
        private bool isShift;

        /// <summary>The tip's way, to either side of it, on which objects that ride along are searched, in metres. After
        /// a shift of the world or a teleport it is the way of that.</summary>
        public double WayMetres => way.Length;

        /// <summary>True where the way is longer than the margin of a search around the tip.</summary>
        public bool IsWide => WayMetres > ShortWayMetres;

        /// <summary>Searches to be made in this frame: after a shift of the world the place before it counts
        /// too.</summary>
        public int Searches => isShift ? 2 : 1;

        /// <summary>Colliders that the last search found.</summary>
        public int Count { get; private set; }

        /// <summary>True where the last search found more than it can hold.</summary>
        public bool IsFull => Count == MaximumColliders;

        /// <summary>A collider that the last search found.</summary>
        public Collider this[int index] => colliders[index];

        /// <summary>Advances the tip.</summary>
        public void BeginFrame(Double3 tipMetres, double nowSeconds)
        {
            Double3 moved = hasPrevious ? tipMetres - previousTipMetres : Double3.Zero;
            double passed = nowSeconds - previousSeconds;
            way = moved;
            isShift = moved.Length > LongestWayMetres;
            if (!isShift && passed > 0.0)
            {
                double stepSeconds = Math.Min(
                    Time.fixedDeltaTime / Math.Max(Time.timeScale, 1e-3f), LongestStepSeconds);
                Double3 longer = moved * (1.0 + stepSeconds / Math.Max(passed, 1e-3));
                way = longer.Length > LongestWayMetres ? longer * (LongestWayMetres / longer.Length) : longer;
            }
            previousTipMetres = tipMetres;
            previousSeconds = nowSeconds;
            hasPrevious = true;
        }

        /// <summary>Discards the tip's way.</summary>
        public void Forget()
        {
            hasPrevious = false;
            isShift = false;
            way = Double3.Zero;
        }

        /// <summary>Finds the colliders within a distance of the line along which the tip came and, at its speed, goes
        /// on.</summary>
        /// <param name="search">Number of the search in this frame, below <see cref="Searches"/>.</param>
        public void Find(in PhysicsScene world, Double3 tipMetres, double metres, int layers, int search)
        {
            Double3 from = isShift && search == 0 ? tipMetres : tipMetres - way;
            Count = isShift || !IsWide
                ? world.OverlapSphere((isShift ? from : tipMetres).ToVector(), (float)metres, colliders, layers,
                    QueryTriggerInteraction.Ignore)
                : world.OverlapCapsule(from.ToVector(), (tipMetres + way).ToVector(), (float)metres, colliders, layers,
                    QueryTriggerInteraction.Ignore);
        }

        /// <summary>Lets go of what was found.</summary>
        public void Clear()
        {
            Array.Clear(colliders, 0, Count);
            Count = 0;
        }
    }
}
