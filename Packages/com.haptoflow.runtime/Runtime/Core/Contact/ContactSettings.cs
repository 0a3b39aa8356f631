#nullable enable
using System;
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>How a velocity is made from tracked positions. See <see cref="TipHistory"/>.</summary>
    internal sealed class VelocitySettings
    {
        /// <summary>The line through the positions covers this much time, or three positions where they are sparser.
        /// </summary>
        public double WindowSeconds { get; set; } = 0.035;

        /// <summary>A repeated position counts as tracker hold up to here, then the velocity fades.</summary>
        public double HoldSeconds { get; set; } = 0.030;

        /// <summary>A position repeated for this long is a stop.</summary>
        public double StopSeconds { get; set; } = 0.050;

        /// <summary>After a longer pause nothing of the past counts.</summary>
        public double LongestGapSeconds { get; set; } = 0.250;

        /// <summary>Samples closer than this in time add nothing to the line but noise.</summary>
        public double ShortestStepSeconds { get; set; } = 0.0005;

        /// <summary>A position that moved less than this is repeated.</summary>
        public double SmallestMoveMetres { get; set; } = 1e-7;

        /// <summary>Faster than this is a teleport. Hands reach a quarter of it.</summary>
        public double FastestMps { get; set; } = 20.0;

        /// <summary>The shortest time over which a jump's speed is judged, so that jittering time stamps are no
        /// teleports.</summary>
        public double ShortestJumpSeconds { get; set; } = 0.005;

        /// <summary>A move longer than this in so much time is a teleport. The fastest speed itself is none, however
        /// its times and places are rounded.</summary>
        public double MaximumMoveMetres(double seconds) =>
            (1.0 + 1e-6) * FastestMps * Math.Max(seconds, ShortestJumpSeconds);
    }

    /// <summary>The contact model's constants: lengths in metres, times in seconds, forces in newtons.</summary>
    internal sealed class ContactSettings
    {
        public double MaximumForceNewtons { get; set; } = 5.0;

        /// <summary>Of surfaces that neither say nor look up their own.</summary>
        public double DefaultStiffnessNewtonsPerMetre { get; set; } = 500.0;

        /// <summary>A touch ends where the gap between tip and surface exceeds this.</summary>
        public double ReleaseDistanceMetres { get; set; } = 0.0005;

        /// <summary>Another surface, or another face of the same, takes over only where it is ahead by this much.
        /// </summary>
        public double SwitchMarginMetres { get; set; } = 0.0005;

        /// <summary>How far behind an open mesh the tip's centre still counts as inside it.</summary>
        public double OpenMeshDepthMetres { get; set; } = 0.005;

        /// <summary>A touch ends where the tip's position stays unusable for longer than this.</summary>
        public double LostSeconds { get; set; } = 0.100;

        public VelocitySettings Velocity { get; set; } = new VelocitySettings();

        /// <exception cref="ArgumentOutOfRangeException">A setting is out of range; the message names it.</exception>
        internal void Check()
        {
            Require(Positive(MaximumForceNewtons), nameof(MaximumForceNewtons), "above 0");
            Require(Positive(DefaultStiffnessNewtonsPerMetre), nameof(DefaultStiffnessNewtonsPerMetre), "above 0");
            Require(NotNegative(ReleaseDistanceMetres), nameof(ReleaseDistanceMetres), "0 or more");
            Require(NotNegative(SwitchMarginMetres), nameof(SwitchMarginMetres), "0 or more");
            Require(NotNegative(OpenMeshDepthMetres), nameof(OpenMeshDepthMetres), "0 or more");
            Require(NotNegative(LostSeconds), nameof(LostSeconds), "0 or more");
            Require(Positive(Velocity.WindowSeconds), nameof(Velocity.WindowSeconds), "above 0");
            Require(NotNegative(Velocity.HoldSeconds), nameof(Velocity.HoldSeconds), "0 or more");
            Require(Positive(Velocity.StopSeconds) && Velocity.StopSeconds > Velocity.HoldSeconds,
                nameof(Velocity.StopSeconds), "above " + nameof(Velocity.HoldSeconds));
            Require(Positive(Velocity.LongestGapSeconds), nameof(Velocity.LongestGapSeconds), "above 0");
            Require(Positive(Velocity.ShortestStepSeconds), nameof(Velocity.ShortestStepSeconds), "above 0");
            Require(NotNegative(Velocity.SmallestMoveMetres), nameof(Velocity.SmallestMoveMetres), "0 or more");
            Require(Positive(Velocity.FastestMps), nameof(Velocity.FastestMps), "above 0");
            Require(Positive(Velocity.ShortestJumpSeconds), nameof(Velocity.ShortestJumpSeconds), "above 0");
        }

        private static bool Positive(double value) => value > 0.0 && Vectors.IsUsable(value);

        private static bool NotNegative(double value) => value >= 0.0 && Vectors.IsUsable(value);

        private static void Require(bool holds, string name, string expectation)
        {
            if (!holds)
            {
                throw new ArgumentOutOfRangeException(name, $"contact: {name} must be {expectation}");
            }
        }
    }
}
