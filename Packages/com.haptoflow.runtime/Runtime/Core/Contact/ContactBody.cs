#nullable enable
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>State of one surface for one tip.</summary>
    internal sealed class ContactBody
    {
        /// <param name="grain">Direction of the first tangent axis, in the object's local frame.</param>
        /// <param name="stiffnessNewtonsPerMetre">Stiffness of the spring model; at 0 or below the default
        /// applies.</param>
        public ContactBody(Double3 grain, double stiffnessNewtonsPerMetre)
        {
            Frame = new TangentFrame(grain);
            StiffnessNewtonsPerMetre = stiffnessNewtonsPerMetre;
        }

        /// <summary>Recent poses, recorded by the caller.</summary>
        public PoseHistory Track { get; } = new PoseHistory();

        public double StiffnessNewtonsPerMetre { get; set; }

        /// <summary>Names the surface to the engine.</summary>
        public uint Seed { get; set; }

        internal TangentFrame Frame { get; }

        /// <summary>Where the tip was in the surface's local frame, and in which frame.</summary>
        internal Double3 TipMetres { get; set; }

        internal ulong TipFrame { get; set; }

        /// <summary>The speed with which the tip came there; infinite where it is not known.</summary>
        internal double TipSpeedMps { get; set; } = double.PositiveInfinity;

        /// <summary>Resets the state for another surface.</summary>
        public void Restart(Double3 grain, double stiffnessNewtonsPerMetre)
        {
            Frame.Restart(grain);
            Track.Clear();
            TipFrame = 0;
            TipSpeedMps = double.PositiveInfinity;
            StiffnessNewtonsPerMetre = stiffnessNewtonsPerMetre;
        }
    }

    /// <summary>A surface near the tip in this frame.</summary>
    internal readonly struct ContactCandidate
    {
        public readonly ContactBody Surface;

        /// <summary>The object's pose; <see cref="Local"/> is the point closest to the tip in its local
        /// frame.</summary>
        public readonly RigidPose Pose;

        public readonly SurfacePoint Local;

        /// <summary>The part of the tip's last way before it entered the surface; more than 1 if it did not.</summary>
        public readonly double EntryShare;

        public ContactCandidate(
            ContactBody surface, in RigidPose pose, in SurfacePoint local, double entryShare = 2.0) =>
            (Surface, Pose, Local, EntryShare) = (surface, pose, local, entryShare);
    }

    /// <summary>Computes closest points for a tracker. Main thread, no garbage.</summary>
    internal interface IContactGeometry
    {
        /// <summary>The point of a surface closest to a tip, in the surface's local frame.</summary>
        /// <param name="surface">A surface that was considered in this frame.</param>
        /// <returns>False where there is none.</returns>
        bool TryClosest(ContactBody surface, Double3 tipMetres, out SurfacePoint found);
    }
}
