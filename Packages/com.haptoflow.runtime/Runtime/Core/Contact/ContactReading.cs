#nullable enable
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>The result of the contact model for one frame: the state for the engine, and the place of the contact
    /// for the scene, in double precision. Every number is finite, whatever the input.</summary>
    internal struct ContactReading
    {
        /// <summary>What the tip does, without the material, which the scene knows. Velocities are along
        /// <see cref="FirstAxis"/> and <see cref="SecondAxis"/>; sliding from one surface to another without lifting is
        /// one touch.</summary>
        public ContactState State;

        public double TimeSeconds;

        /// <summary>The touched surface; null without touch.</summary>
        public ContactBody? Surface;

        /// <summary>Contact point on the surface; the tip's centre without touch.</summary>
        public Double3 PointMetres;

        /// <summary>Unit normal out of the surface; +y without touch.</summary>
        public Double3 Normal;

        /// <summary>Penetration depth: tip radius minus signed distance, not below 0.</summary>
        public double PenetrationMetres;

        /// <summary>The first tangent axis in world space; zero without touch.</summary>
        public Double3 FirstAxis;

        /// <summary>The second tangent axis in world space; zero without touch.</summary>
        public Double3 SecondAxis;
    }

    /// <summary>Corrections to the tip's samples. Counts since construction.</summary>
    public struct ContactStatistics
    {
        /// <summary>Samples of the tip.</summary>
        public ulong Samples;

        /// <summary>Samples with an unusable time, position or force.</summary>
        public ulong SanitisedSamples;

        /// <summary>Jumps of the tip over the surface that it touched, which no hand can make.</summary>
        public ulong Teleports;

        /// <summary>Times that the clock went backwards and the history was discarded.</summary>
        public ulong ClockRestarts;

        /// <summary>Touch-downs.</summary>
        public ulong TouchDowns;
    }

    /// <summary>A sample of the stylus tip.</summary>
    internal readonly struct TipSample
    {
        /// <summary>Time on any monotonic clock.</summary>
        public readonly double TimeSeconds;

        /// <summary>Centre of the tip sphere.</summary>
        public readonly Double3 PositionMetres;

        /// <summary>Measured tip force, which replaces the spring force; null without one.</summary>
        public readonly double? ForceNewtons;

        public TipSample(double timeSeconds, Double3 positionMetres, double? forceNewtons = null) =>
            (TimeSeconds, PositionMetres, ForceNewtons) = (timeSeconds, positionMetres, forceNewtons);
    }

    /// <summary>How unevenly places follow each other: the sum of the squares of the changes of velocity between them, in
    /// (m/s)^2.</summary>
    internal struct Roughness
    {
        private double seconds;
        private Double3 place;
        private Double3 velocity;

        /// <summary>Places so far.</summary>
        public int Count { get; private set; }

        public double Squares { get; private set; }

        /// <summary>Adds a place, later than the last.</summary>
        public void Add(double timeSeconds, Double3 placeMetres)
        {
            if (Count > 0)
            {
                Double3 now = (placeMetres - place) / (timeSeconds - seconds);
                Squares += Count > 1 ? Double3.Dot(now - velocity, now - velocity) : 0.0;
                velocity = now;
            }
            seconds = timeSeconds;
            place = placeMetres;
            ++Count;
        }
    }

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
