#nullable enable
using System;
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>A collider near one tip: its material, by its surface or by rules, and its recent poses.</summary>
    internal sealed class NearbyCollider
    {
        public Collider? Collider { get; private set; }

        /// <summary>Null for a collider whose material rules assign.</summary>
        public HapticSurface? Surface { get; private set; }

        /// <summary>Null for a collider with a surface.</summary>
        public MappedCollider? ByRules { get; private set; }

        /// <summary>The point closest to the tip in the last update in which the collider was within reach.</summary>
        public TouchedPlace Place { get; set; }

        public ResolvedMaterial Felt { get; private set; }

        public ContactBody Tracked { get; } = new ContactBody(Double3.Right, 0.0);

        /// <summary>Number of the last update in which the collider was near.</summary>
        public long LastUpdate { get; set; }

        /// <summary>Number of the last update in which a search found the collider.</summary>
        public long LastFound { get; set; }

        /// <summary>True for a mesh that is drawn elsewhere than in the last update and is not interpolated: physics may
        /// not know yet.</summary>
        /// <param name="scale">Metres of the world for a metre of the hand.</param>
        public bool IsMovedMesh(double scale)
        {
            if (!(Collider is MeshCollider mesh) || mesh == null || Tracked.Track.Count == 0)
            {
                return false;
            }
            Rigidbody body = mesh.attachedRigidbody!;
            bool isDrawnByPhysics = body != null && body.interpolation != RigidbodyInterpolation.None;
            return !isDrawnByPhysics &&
                !RigScale.ToHand(ColliderProbe.PoseOf(mesh), scale).Equals(Tracked.Track.Newest);
        }

        /// <param name="surface">Null for a collider whose material rules assign.</param>
        public void Begin(Collider collider, HapticSurface? surface, MappedCollider? byRules)
        {
            Collider = collider;
            Surface = surface;
            ByRules = byRules;
            (Place, Felt) = (default, default);
            Tracked.Restart(GrainOf(collider, surface), 0.0);
            Tracked.Seed = SurfaceSeeds.Of(collider, surface);
        }

        /// <summary>The grain in the collider's local frame.</summary>
        public static Double3 GrainOf(Collider collider, HapticSurface? surface)
        {
            Vector3 grain = surface is object
                ? surface.transform.TransformDirection(surface.Grain)
                : collider.transform.TransformDirection(Vector3.right);
            return ColliderProbe.PoseOf(collider).DirectionToLocal(grain.ToDouble());
        }

        /// <summary>True for this collider with the same source of its material.</summary>
        public bool Is(Collider collider, HapticSurface? surface, MappedCollider? byRules) =>
            ReferenceEquals(Collider, collider) && ReferenceEquals(Surface, surface) && ReferenceEquals(ByRules, byRules);

        public void End()
        {
            Collider = null;
            Surface = null;
            ByRules = null;
            (Place, Felt) = (default, default);
        }

        public void Resolve(HapticSession session) => Felt = Surface is object
            ? Surface.At(Place, session)
            : ByRules is object ? ByRules.At(Place, session) : default;

        /// <summary>Records the pose at which the collider is drawn in a frame.</summary>
        /// <param name="secondsSinceStep">Time since the last physics step, on the same clock; not a number where none
        /// runs.</param>
        public void Record(double nowSeconds, double secondsSinceStep, in RigidPose pose)
        {
            if (Surface is object && !Surface.FeelOwnMotion)
            {
                Tracked.Track.Clear();
                return;
            }
            Tracked.Track.Record(nowSeconds, pose, Collider!.transform.lossyScale.ToDouble(), secondsSinceStep);
        }
    }

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

        public int Count { get; private set; }

        public bool IsFull => Count == MaximumColliders;

        public Collider this[int index] => colliders[index];

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

        public void Clear()
        {
            Array.Clear(colliders, 0, Count);
            Count = 0;
        }
    }
}
