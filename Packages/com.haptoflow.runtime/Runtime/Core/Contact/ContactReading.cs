#nullable enable
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>One contact state with where it comes from. Every number is finite, whatever the input.</summary>
    internal struct ContactReading
    {
        public double TimeSeconds;
        public bool Touching;

        /// <summary>Counts touch-downs; sliding from one surface to the next without lifting is one touch.</summary>
        public uint TouchCounter;

        /// <summary>What is touched; null without touch.</summary>
        public TrackedSurface? Surface;

        /// <summary>On the surface; the tip's centre without touch.</summary>
        public Double3 PointMetres;

        /// <summary>Unit length, out of the surface; +y without touch.</summary>
        public Double3 Normal;

        /// <summary>Tip radius minus signed distance, not below 0.</summary>
        public double PenetrationMetres;

        /// <summary>Of the tip relative to the surface, along <see cref="FirstAxis"/>, in m/s.</summary>
        public double FirstVelocityMps;

        /// <summary>Of the tip relative to the surface, along <see cref="SecondAxis"/>, in m/s.</summary>
        public double SecondVelocityMps;

        /// <summary>The surface's tangent axes in world space; zero without touch.</summary>
        public Double3 FirstAxis;

        /// <summary>The surface's tangent axes in world space; zero without touch.</summary>
        public Double3 SecondAxis;

        /// <summary>Into the surface at this touch's newest landing, not below 0; 0 without touch.</summary>
        public double ApproachSpeedMps;

        public double ForceNewtons;

        /// <summary>Counts landings within touches: on another surface, or on another face of the same.</summary>
        public uint LandingCounter;

        /// <summary>Counts edges: rims that the tip crosses or slides off, and steps from one surface to the next.
        /// </summary>
        public uint EdgeCounter;

        /// <summary>Of the newest edge; 0 before the first.</summary>
        public double EdgeHeightMetres;
    }

    /// <summary>What had to be put right. Counts since construction.</summary>
    public struct ContactStatistics
    {
        /// <summary>Samples of the tip.</summary>
        public ulong Samples;

        /// <summary>Samples with a time, position or force that was not usable.</summary>
        public ulong SanitisedSamples;

        /// <summary>Jumps that no hand makes.</summary>
        public ulong Teleports;

        /// <summary>The time went backwards and the past was dropped.</summary>
        public ulong ClockRestarts;

        /// <summary>Touches that began.</summary>
        public ulong TouchDowns;
    }
}
