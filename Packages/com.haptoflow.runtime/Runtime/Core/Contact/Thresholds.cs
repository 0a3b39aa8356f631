#nullable enable
using System;
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    internal enum ForceVerdict
    {
        /// <summary>No recent measurement: geometry decides.</summary>
        Unknown,

        Lifted,

        Pressed,
    }

    /// <summary>Decides from the measured tip force whether a pen touches. Tracking places a real object some
    /// millimetres away from the virtual one, but the force is present exactly while the pen rests on it. One thread at
    /// a time; no garbage after construction.</summary>
    internal sealed class ForceTouch
    {
        // The defaults suit a pen that rests on a desk, as MX Ink does.
        public const double DefaultPressNewtons = 0.05;
        public const double DefaultReleaseNewtons = 0.02;
        public const double DefaultNearMetres = 0.02;

        // Additional distance for the surface that is already touched.
        private const double NearMarginMetres = 0.005;

        // Time after which a missing force counts as not measured.
        private const double HoldSeconds = 0.050;
        private double measuredSeconds;

        public double PressNewtons { get; set; } = DefaultPressNewtons;

        /// <summary>A touch ends at this force or below it. The gap up to <see cref="PressNewtons"/> must exceed the
        /// sensor's noise.</summary>
        public double ReleaseNewtons { get; set; } = DefaultReleaseNewtons;

        /// <summary>Distance from a surface, on either side, up to which a pressing tip touches it. It must exceed the
        /// error of tracking and alignment together.</summary>
        public double NearMetres { get; set; } = DefaultNearMetres;

        /// <summary>Up to this distance the surface that is already touched is near.</summary>
        public double ReachMetres => NearMetres + NearMarginMetres;

        public ForceVerdict Verdict { get; private set; }

        /// <summary>Last measured force, 0 or more; 0 without one.</summary>
        public double ForceNewtons { get; private set; }

        /// <summary>Processes one frame's force.</summary>
        /// <param name="timeSeconds">Time on any clock; one that runs backwards restarts the hold time.</param>
        /// <param name="forceNewtons">The force; null where the device reports none. A force that is not finite or
        /// below 0 counts as none.</param>
        public ForceVerdict Update(double timeSeconds, double? forceNewtons)
        {
            if (forceNewtons.HasValue && Vectors.IsUsable(forceNewtons.Value) && forceNewtons.Value >= 0.0)
            {
                ForceNewtons = forceNewtons.Value;
                measuredSeconds = timeSeconds;
                double threshold = Verdict == ForceVerdict.Pressed ? ReleaseNewtons : PressNewtons;
                bool pressed = Verdict == ForceVerdict.Pressed ? ForceNewtons > threshold : ForceNewtons >= threshold;
                Verdict = pressed ? ForceVerdict.Pressed : ForceVerdict.Lifted;
                return Verdict;
            }
            measuredSeconds = Math.Min(measuredSeconds, timeSeconds);
            // The negated comparison also ends the hold for a time that is NaN.
            if (Verdict != ForceVerdict.Unknown && !(timeSeconds - measuredSeconds <= HoldSeconds))
            {
                Reset();
            }
            return Verdict;
        }

        /// <summary>True where a surface is close enough for a pressing tip to be on it.</summary>
        /// <param name="signedDistanceMetres">Distance from the tip sphere to the surface, negative where it cuts
        /// in.</param>
        public bool IsNear(double signedDistanceMetres, bool isTouched) =>
            Math.Abs(signedDistanceMetres) <= (isTouched ? ReachMetres : NearMetres);

        public void Reset()
        {
            Verdict = ForceVerdict.Unknown;
            ForceNewtons = 0.0;
            measuredSeconds = double.NegativeInfinity;
        }
    }

    /// <summary>Detects from frame to frame whether a tip moves over a surface, for signals that start and stop
    /// with the motion: by the last two measurements alone, whatever came before.</summary>
    /// <remarks>Two thresholds keep a tracker's noise and a hand's tremor (some 10 mm/s) from switching a signal at
    /// rest. The difference of two frames lags by half a frame, which is counted as part of the pose
    /// interval.</remarks>
    internal sealed class MotionGate
    {
        /// <summary>Speed at which a tip at rest starts to move.</summary>
        public const double StartSpeedMps = 0.03;

        /// <summary>Speed below which a moving tip comes to rest.</summary>
        public const double StopSpeedMps = 0.015;

        // A tracker slower than the frame rate repeats positions.
        private const double MaximumRepeatSeconds = 0.03;
        private const double MinimumMoveMetres = 1e-7;
        private const double MinimumStepSeconds = 0.0005;

        private bool hasPlace;
        private double measuredSeconds;
        private Double3 measuredMetres;

        public bool Moves { get; private set; }

        /// <summary>Speed between the last two measurements.</summary>
        public double SpeedMps { get; private set; }

        /// <summary>Processes one frame.</summary>
        /// <param name="pointMetres">Contact point, in the surface's frame or, over a surface at rest, in the
        /// world.</param>
        /// <returns><see cref="Moves"/>.</returns>
        public bool Update(double nowSeconds, bool touching, in Double3 pointMetres)
        {
            if (!touching)
            {
                hasPlace = false;
                Moves = false;
                SpeedMps = 0.0;
                return false;
            }
            double passed = nowSeconds - measuredSeconds;
            if (!hasPlace || passed < 0.0)
            {
                Measure(nowSeconds, pointMetres);
                return Moves;
            }
            double moved = Double3.Distance(pointMetres, measuredMetres);
            bool isRepeat = moved < MinimumMoveMetres && passed < MaximumRepeatSeconds;
            if (passed >= MinimumStepSeconds && !isRepeat)
            {
                Measure(nowSeconds, pointMetres);
                SpeedMps = moved / passed;
                Moves = SpeedMps >= (Moves ? StopSpeedMps : StartSpeedMps);
            }
            return Moves;
        }

        /// <summary>The tip has slid to another surface, where its point has other coordinates.</summary>
        public void Continue(double nowSeconds, in Double3 pointMetres) => Measure(nowSeconds, pointMetres);

        private void Measure(double nowSeconds, in Double3 pointMetres)
        {
            hasPlace = true;
            measuredSeconds = nowSeconds;
            measuredMetres = pointMetres;
        }
    }
}
