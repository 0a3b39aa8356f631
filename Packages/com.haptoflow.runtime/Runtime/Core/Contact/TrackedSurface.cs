#nullable enable
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>What one tip remembers of one surface.</summary>
    internal sealed class TrackedSurface
    {
        /// <param name="grain">Direction of the first tangent axis, in the object's local frame.</param>
        /// <param name="stiffnessNewtonsPerMetre">Of the spring model; where it is not above 0, the default counts.
        /// </param>
        public TrackedSurface(Double3 grain, double stiffnessNewtonsPerMetre)
        {
            Frame = new TangentFrame(grain);
            StiffnessNewtonsPerMetre = stiffnessNewtonsPerMetre;
        }

        /// <summary>Where it was, written by whoever knows.</summary>
        public SurfaceTrack Track { get; } = new SurfaceTrack();

        public double StiffnessNewtonsPerMetre { get; set; }

        internal TangentFrame Frame { get; }

        /// <summary>As new, for another surface.</summary>
        public void Restart(Double3 grain, double stiffnessNewtonsPerMetre)
        {
            Frame.Restart(grain);
            Track.Clear();
            StiffnessNewtonsPerMetre = stiffnessNewtonsPerMetre;
        }
    }

    /// <summary>A surface near the tip, in this frame.</summary>
    internal readonly struct ContactCandidate
    {
        public readonly TrackedSurface Surface;

        /// <summary>The object's pose now, and the place nearest to the tip in its local frame.</summary>
        public readonly RigidPose Pose;

        public readonly SurfacePoint Local;

        public ContactCandidate(TrackedSurface surface, in RigidPose pose, in SurfacePoint local)
        {
            Surface = surface;
            Pose = pose;
            Local = local;
        }
    }

    /// <summary>Does the geometry for a tracker. Main thread, no garbage.</summary>
    internal interface ISurfaceGeometry
    {
        /// <summary>The place of a surface nearest to a tip, in the surface's local frame.</summary>
        /// <param name="surface">One that was considered in this frame.</param>
        /// <returns>False where there is none.</returns>
        bool TryClosest(TrackedSurface surface, Double3 tipMetres, out SurfacePoint found);
    }
}
