#nullable enable
using System;

namespace HaptoFlow.Contact
{
    /// <summary>Settings for the velocity from tracked positions. See <see cref="TipPath"/>.</summary>
    internal sealed class VelocitySettings
    {
        /// <summary>The longest time from which positions are taken, no whole number of usual frames, so that rounding
        /// does not decide how many; two positions are always taken.</summary>
        public double WindowSeconds { get; set; } = 0.105;

        /// <summary>The time over which the speed of an approach is averaged, or three positions if they are sparser:
        /// what a tip meets has turned it by the time that it is noticed.</summary>
        public double ApproachSeconds { get; set; } = 0.035;

        /// <summary>A position repeated for up to this long counts as held by a tracker that repeats itself; then the
        /// velocity fades.</summary>
        public double HoldSeconds { get; set; } = 0.030;

        /// <summary>A position repeated for this long by such a tracker counts as a stop.</summary>
        public double StopSeconds { get; set; } = 0.050;

        /// <summary>After a longer pause the history is discarded.</summary>
        public double MaximumGapSeconds { get; set; } = 0.250;

        /// <summary>Samples closer in time than this are skipped: they would add only noise.</summary>
        public double MinimumStepSeconds { get; set; } = 0.0005;

        /// <summary>A move shorter than this counts as a repeated position.</summary>
        public double MinimumMoveMetres { get; set; } = 1e-7;

        /// <summary>A faster move over the surface is a jump. Hands reach a quarter of this speed.</summary>
        public double MaximumSpeedMps { get; set; } = 20.0;

        /// <summary>A tip that gains more speed from one measurement to the next, and more than <see
        /// cref="JumpAccelerationMps2"/> gives in the time, has jumped. Strokes of people gain 2 m/s at 200 Hz and 1.4
        /// m/s at 72 Hz at most, 100 m/s^2.</summary>
        public double JumpGainMps { get; set; } = 2.5;

        /// <summary>See <see cref="JumpGainMps"/>.</summary>
        public double JumpAccelerationMps2 { get; set; } = 150.0;

        /// <summary>Shortest time for the speed of a jump, so that jittering time stamps do not count as
        /// jumps.</summary>
        public double MinimumJumpSeconds { get; set; } = 0.005;

        /// <summary>The longest move in a time that is not a jump. A small margin keeps moves at exactly the maximum
        /// speed from counting as jumps by rounding.</summary>
        public double MaximumMoveMetres(double seconds) =>
            (1.0 + 1e-6) * MaximumSpeedMps * Math.Max(seconds, MinimumJumpSeconds);

        /// <summary>The most speed that a hand gains in a time.</summary>
        public double MaximumGainMps(double seconds) => Math.Max(JumpGainMps, JumpAccelerationMps2 * seconds);

        /// <summary>True if the tip moved further than a hand can in this time: it was put there, as by a
        /// teleport.</summary>
        /// <param name="speedBeforeMps">The speed before the step; infinite where it is not known.</param>
        public bool IsJump(double movedMetres, double seconds, double speedBeforeMps)
        {
            double step = Math.Max(seconds, MinimumJumpSeconds);
            return movedMetres > MaximumMoveMetres(step) ||
                movedMetres > (speedBeforeMps + MaximumGainMps(step)) * step;
        }
    }

    /// <summary>Settings of the contact model: lengths in metres, times in seconds, forces in newtons.</summary>
    internal sealed class ContactSettings
    {
        public double MaximumForceNewtons { get; set; } = 5.0;

        /// <summary>Stiffness of surfaces that have none of their own and no label that gives one.</summary>
        public double DefaultStiffnessNewtonsPerMetre { get; set; } = 500.0;

        /// <summary>A touch ends when the gap between tip and surface exceeds this distance.</summary>
        public double ReleaseDistanceMetres { get; set; } = 0.0005;

        /// <summary>Another surface, or another face of the same one, is taken only when it is ahead by this
        /// distance.</summary>
        public double SwitchMarginMetres { get; set; } = 0.0005;

        /// <summary>Depth behind an open mesh up to which the tip's centre counts as inside.</summary>
        public double OpenMeshDepthMetres { get; set; } = 0.005;

        /// <summary>A touch ends when the tip's position has been unusable for longer than this time.</summary>
        public double LostSeconds { get; set; } = 0.100;

        public VelocitySettings Velocity { get; set; } = new VelocitySettings();
    }
}
