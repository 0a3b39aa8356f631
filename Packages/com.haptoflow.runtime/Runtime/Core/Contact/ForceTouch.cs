#nullable enable
using System;
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>Thresholds that turn a measured tip force into touches: forces in newtons, lengths in metres, times in
    /// seconds. The defaults suit a pen that rests on a desk, as MX Ink does.</summary>
    internal sealed class ForceTouchSettings
    {
        public const double DefaultPressNewtons = 0.05;
        public const double DefaultReleaseNewtons = 0.02;
        public const double DefaultNearMetres = 0.02;

        /// <summary>A touch begins at this force.</summary>
        public double PressNewtons { get; set; } = DefaultPressNewtons;

        /// <summary>A touch ends at this force or below it. The gap up to <see cref="PressNewtons"/> must exceed the
        /// sensor's noise.</summary>
        public double ReleaseNewtons { get; set; } = DefaultReleaseNewtons;

        /// <summary>Distance from a surface, on either side, up to which a pressing tip touches it. It must exceed the
        /// error of tracking and alignment together.</summary>
        public double NearMetres { get; set; } = DefaultNearMetres;

        /// <summary>Additional distance for the surface that is already touched.</summary>
        public double NearMarginMetres { get; set; } = 0.005;

        /// <summary>Time after which a missing force counts as not measured.</summary>
        public double HoldSeconds { get; set; } = 0.050;
    }

    /// <summary>State of a tip according to its force.</summary>
    internal enum ForceVerdict
    {
        /// <summary>No recent measurement: geometry decides.</summary>
        Unknown,

        /// <summary>The tip is in the air.</summary>
        Lifted,

        /// <summary>The tip presses on a real object.</summary>
        Pressed,
    }

    /// <summary>Decides from the measured tip force whether a pen touches. Tracking places a real object some
    /// millimetres away from the virtual one, but the force is present exactly while the pen rests on it. One thread at
    /// a time; no garbage after construction.</summary>
    internal sealed class ForceTouch
    {
        private double measuredSeconds;

        public ForceTouch(ForceTouchSettings settings) => Settings = settings;

        public ForceTouchSettings Settings { get; }

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
                double threshold = Verdict == ForceVerdict.Pressed ? Settings.ReleaseNewtons : Settings.PressNewtons;
                bool pressed = Verdict == ForceVerdict.Pressed ? ForceNewtons > threshold : ForceNewtons >= threshold;
                Verdict = pressed ? ForceVerdict.Pressed : ForceVerdict.Lifted;
                return Verdict;
            }
            measuredSeconds = Math.Min(measuredSeconds, timeSeconds);
            // The negated comparison also ends the hold for a time that is NaN.
            if (Verdict != ForceVerdict.Unknown && !(timeSeconds - measuredSeconds <= Settings.HoldSeconds))
            {
                Reset();
            }
            return Verdict;
        }

        /// <summary>True where a surface is close enough for a pressing tip to be on it.</summary>
        /// <param name="signedDistanceMetres">Distance from the tip sphere to the surface, negative where it cuts
        /// in.</param>
        /// <param name="isTouched">True where the surface was touched in the last frame.</param>
        public bool IsNear(double signedDistanceMetres, bool isTouched) =>
            Math.Abs(signedDistanceMetres) <= Settings.NearMetres + (isTouched ? Settings.NearMarginMetres : 0.0);

        /// <summary>Discards the state: the pen was put away or handed over.</summary>
        public void Reset()
        {
            Verdict = ForceVerdict.Unknown;
            ForceNewtons = 0.0;
            measuredSeconds = double.NegativeInfinity;
        }
    }
}
