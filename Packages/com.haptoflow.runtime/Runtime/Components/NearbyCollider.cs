#nullable enable
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

        /// <summary>The material at <see cref="Place"/>, as of the last <see cref="Feel"/>.</summary>
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
            Vector3 grain = surface is object
                ? surface.transform.TransformDirection(surface.Grain)
                : collider.transform.TransformDirection(Vector3.right);
            Tracked.Restart(ColliderProbe.PoseOf(collider).DirectionToLocal(grain.ToDouble()), 0.0);
            Tracked.Seed = SurfaceSeeds.Of(collider, surface);
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

        /// <summary>Finds the material at <see cref="Place"/>. No garbage while nothing changes.</summary>
        public void Feel(HapticSession session) => Felt = Surface is object
            ? Surface.At(Place, session)
            : ByRules is object ? ByRules.At(Place, session) : default;

        /// <summary>Records the pose at which the collider is drawn in a frame.</summary>
        /// <param name="nowSeconds">The tip's clock.</param>
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
}
