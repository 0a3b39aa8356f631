#nullable enable
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>The result of the contact model for one frame. Every number is finite, whatever the input.</summary>
    internal struct ContactReading
    {
        public double TimeSeconds;
        public bool Touching;

        /// <summary>Number of touch-downs; sliding from one surface to another without lifting is one touch.</summary>
        public uint TouchCounter;

        /// <summary>The touched surface; null without touch.</summary>
        public ContactBody? Surface;

        /// <summary>Contact point on the surface; the tip's centre without touch.</summary>
        public Double3 PointMetres;

        /// <summary>Unit normal out of the surface; +y without touch.</summary>
        public Double3 Normal;

        /// <summary>Penetration depth: tip radius minus signed distance, not below 0.</summary>
        public double PenetrationMetres;

        /// <summary>Velocity of the tip relative to the surface along <see cref="FirstAxis"/>, in m/s.</summary>
        public double FirstVelocityMps;

        /// <summary>Velocity of the tip relative to the surface along <see cref="SecondAxis"/>, in m/s.</summary>
        public double SecondVelocityMps;

        /// <summary>The first tangent axis in world space; zero without touch.</summary>
        public Double3 FirstAxis;

        /// <summary>The second tangent axis in world space; zero without touch.</summary>
        public Double3 SecondAxis;

        /// <summary>Speed into the surface at the last landing of this touch, not below 0; 0 without touch.</summary>
        public double ApproachSpeedMps;

        public double ForceNewtons;

        /// <summary>Number of landings within touches: on another surface, or on another face of the same
        /// one.</summary>
        public uint LandingCounter;

        /// <summary>Number of edges: rims that the tip crossed or slid off, and steps between surfaces.</summary>
        public uint EdgeCounter;

        /// <summary>Height of the last edge; 0 before the first.</summary>
        public double EdgeHeightMetres;
    }

    /// <summary>Corrections to the tip's samples. Counts since construction.</summary>
    public struct ContactStatistics
    {
        /// <summary>Samples of the tip.</summary>
        public ulong Samples;

        /// <summary>Samples with an unusable time, position or force.</summary>
        public ulong SanitisedSamples;

        /// <summary>Jumps faster than a hand can move.</summary>
        public ulong Teleports;

        /// <summary>Times that the clock went backwards and the history was discarded.</summary>
        public ulong ClockRestarts;

        /// <summary>Touch-downs.</summary>
        public ulong TouchDowns;
    }
}
