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
}
