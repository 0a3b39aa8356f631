#nullable enable
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>A collider near one tip: what it feels like, by its surface or by rules, and where it was lately.
    /// </summary>
    internal sealed class NearbySurface
    {
        private double lastStepSeconds;
        private RigidPose lastPose;
        private bool movesBetweenSteps;

        public Collider? Collider { get; private set; }

        /// <summary>Null for a collider that is felt by rules.</summary>
        public HapticSurface? Surface { get; private set; }

        /// <summary>Null for a collider with a surface.</summary>
        public FeltCollider? ByRules { get; private set; }

        /// <summary>The place nearest to the tip, of the last update that met it within reach.</summary>
        public TouchedPlace Place { get; set; }

        public TrackedSurface Tracked { get; } = new TrackedSurface(Double3.Right, 0.0);

        /// <summary>Number of the last update that met it.</summary>
        public long LastMet { get; set; }

        /// <param name="surface">Null for a collider that is felt by rules.</param>
        public void Begin(Collider collider, HapticSurface? surface, FeltCollider? byRules)
        {
            Collider = collider;
            Surface = surface;
            ByRules = byRules;
            Place = default;
            lastStepSeconds = double.NegativeInfinity;
            movesBetweenSteps = false;
            Vector3 grain = surface is object
                ? surface.transform.TransformDirection(surface.Grain)
                : collider.transform.TransformDirection(Vector3.right);
            Tracked.Restart(ColliderProbe.PoseOf(collider).DirectionToLocal(grain.ToDouble()), 0.0);
        }

        public void End()
        {
            Collider = null;
            Surface = null;
            ByRules = null;
            Place = default;
        }

        /// <summary>What is felt at <see cref="Place"/> now. No garbage while nothing changes.</summary>
        public FeltMaterial Feel(HapticSession session)
        {
            if (Surface is object)
            {
                return Surface.At(Place, session);
            }
            return ByRules is object ? ByRules.At(Place, session) : default;
        }

        /// <summary>Where the collider is drawn now.</summary>
        /// <remarks>A body without interpolation is drawn where the last physics step left it, several frames long at
        /// the same place: recorded at the frames' times it would stand and jump. It counts at the time of its step,
        /// and in between it is carried on.</remarks>
        /// <param name="nowSeconds">The tip's clock.</param>
        /// <param name="stepSeconds">Time of the last physics step, on the same clock.</param>
        public void Record(double nowSeconds, double stepSeconds, in RigidPose pose)
        {
            if (Surface is object && !Surface.FeelOwnMotion)
            {
                Tracked.Track.Clear();
                return;
            }
            if (movesBetweenSteps || !IsStepped())
            {
                Tracked.Track.Record(nowSeconds, pose);
                return;
            }
            if (stepSeconds > lastStepSeconds)
            {
                lastStepSeconds = stepSeconds;
                lastPose = pose;
                Tracked.Track.Record(stepSeconds, pose);
            }
            else if (!pose.Equals(lastPose))
            {
                movesBetweenSteps = true;
                Tracked.Track.Clear();
                Tracked.Track.Record(nowSeconds, pose);
            }
        }

        private bool IsStepped()
        {
            Rigidbody body = Collider!.attachedRigidbody!;
            return body != null
                ? body.interpolation == RigidbodyInterpolation.None
                : Collider.attachedArticulationBody != null;
        }
    }
}
