#nullable enable
using System;
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

    internal readonly struct TipSample
    {
        public readonly double TimeSeconds;

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

        public int Count { get; private set; }

        public double Squares { get; private set; }

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
        /// <returns>False where there is none.</returns>
        bool TryClosest(ContactBody surface, Double3 tipMetres, out SurfacePoint found);
    }

    /// <summary>Limits for the velocity from tracked positions. See <see cref="TipPath"/>.</summary>
    internal static class VelocitySettings
    {
        /// <summary>The longest time from which positions are taken, no whole number of usual frames, so that rounding
        /// does not decide how many; two positions are always taken.</summary>
        public const double WindowSeconds = 0.105;

        /// <summary>The time over which the speed of an approach is averaged, or three positions if they are sparser:
        /// what a tip meets has turned it by the time that it is noticed.</summary>
        public const double ApproachSeconds = 0.035;

        /// <summary>A position repeated for up to this long counts as held by a tracker that repeats itself; then the
        /// velocity fades.</summary>
        public const double HoldSeconds = 0.030;

        /// <summary>A position repeated for this long by such a tracker counts as a stop.</summary>
        public const double StopSeconds = 0.050;

        /// <summary>After a longer pause the history is discarded.</summary>
        public const double MaximumGapSeconds = 0.250;

        /// <summary>Samples closer in time than this are skipped: they would add only noise.</summary>
        public const double MinimumStepSeconds = 0.0005;

        /// <summary>A move shorter than this counts as a repeated position.</summary>
        public const double MinimumMoveMetres = 1e-7;

        /// <summary>A faster move over the surface is a jump. Hands reach a quarter of this speed.</summary>
        public const double MaximumSpeedMps = 20.0;

        /// <summary>A tip that gains more speed from one measurement to the next, and more than <see
        /// cref="JumpAccelerationMps2"/> gives in the time, has jumped. Strokes of people gain 2 m/s at 200 Hz and 1.4
        /// m/s at 72 Hz at most, 100 m/s^2.</summary>
        public const double JumpGainMps = 2.5;

        public const double JumpAccelerationMps2 = 150.0;

        /// <summary>Shortest time for the speed of a jump, so that jittering time stamps do not count as
        /// jumps.</summary>
        public const double MinimumJumpSeconds = 0.005;

        /// <summary>The longest move in a time that is not a jump. A small margin keeps moves at exactly the maximum
        /// speed from counting as jumps by rounding.</summary>
        public static double MaximumMoveMetres(double seconds) =>
            (1.0 + 1e-6) * MaximumSpeedMps * Math.Max(seconds, MinimumJumpSeconds);

        /// <summary>The most speed that a hand gains in a time.</summary>
        public static double MaximumGainMps(double seconds) => Math.Max(JumpGainMps, JumpAccelerationMps2 * seconds);

        /// <summary>True if the tip moved further than a hand can in this time: it was put there, as by a
        /// teleport.</summary>
        public static bool IsJump(double movedMetres, double seconds, double speedBeforeMps)
        {
            double step = Math.Max(seconds, MinimumJumpSeconds);
            return movedMetres > MaximumMoveMetres(step) ||
                movedMetres > (speedBeforeMps + MaximumGainMps(step)) * step;
        }
    }
}
