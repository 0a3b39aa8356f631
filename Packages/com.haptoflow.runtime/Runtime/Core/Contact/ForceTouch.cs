#nullable enable
using System;
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>When a measured tip force is a touch: forces in newtons, lengths in metres, times in seconds. The
    /// defaults are for a pen that rests on a desk, as MX Ink does.</summary>
    internal sealed class ForceTouchSettings
    {
        public const double DefaultPressNewtons = 0.05;
        public const double DefaultReleaseNewtons = 0.02;
        public const double DefaultNearMetres = 0.02;

        /// <summary>A touch begins at this force.</summary>
        public double PressNewtons { get; set; } = DefaultPressNewtons;

        /// <summary>A touch ends at this force or below it: the gap up to <see cref="PressNewtons"/> is wider than the
        /// sensor's noise.</summary>
        public double ReleaseNewtons { get; set; } = DefaultReleaseNewtons;

        /// <summary>A surface is near while the tip is no farther from it, on either side: wider than the error of
        /// tracking and alignment together.</summary>
        public double NearMetres { get; set; } = DefaultNearMetres;

        /// <summary>A touched surface stays near for so much more.</summary>
        public double NearMarginMetres { get; set; } = 0.005;

        /// <summary>A force that stays away for longer is not measured any more.</summary>
        public double HoldSeconds { get; set; } = 0.050;

        /// <exception cref="ArgumentOutOfRangeException">A setting is out of range; the message names it.</exception>
        internal void Check()
        {
            Require(PressNewtons > 0.0 && Vectors.IsUsable(PressNewtons), nameof(PressNewtons), "above 0");
            Require(ReleaseNewtons >= 0.0 && ReleaseNewtons < PressNewtons,
                nameof(ReleaseNewtons), "0 or more and below " + nameof(PressNewtons));
            Require(NearMetres > 0.0 && Vectors.IsUsable(NearMetres), nameof(NearMetres), "above 0");
            Require(NearMarginMetres >= 0.0 && Vectors.IsUsable(NearMarginMetres), nameof(NearMarginMetres),
                "0 or more");
            Require(HoldSeconds >= 0.0 && Vectors.IsUsable(HoldSeconds), nameof(HoldSeconds), "0 or more");
        }

        private static void Require(bool holds, string name, string expectation)
        {
            if (!holds)
            {
                throw new ArgumentOutOfRangeException(name, $"force touch: {name} must be {expectation}");
            }
        }
    }

    /// <summary>What a tip force says.</summary>
    internal enum ForceVerdict
    {
        /// <summary>No force was measured lately: geometry decides.</summary>
        Unknown,

        /// <summary>The tip is in the air.</summary>
        Lifted,

        /// <summary>The tip presses on something real.</summary>
        Pressed,
    }

    /// <summary>Decides by the measured tip force whether a pen touches: a real object under a virtual one is met some
    /// millimetres away from where tracking has it, but the force is there exactly while the pen rests on it. One thread
    /// at a time; no garbage after construction.</summary>
    internal sealed class ForceTouch
    {
        private double measuredSeconds;

        /// <exception cref="ArgumentOutOfRangeException">A setting is out of range.</exception>
        public ForceTouch(ForceTouchSettings settings)
        {
            settings.Check();
            Settings = settings;
        }

        public ForceTouchSettings Settings { get; }

        public ForceVerdict Verdict { get; private set; }

        /// <summary>Last measured force, 0 or more; 0 where none is known.</summary>
        public double ForceNewtons { get; private set; }

        /// <summary>One frame's force.</summary>
        /// <param name="timeSeconds">On any clock; one that runs backwards starts the hold time anew.</param>
        /// <param name="forceNewtons">Null where the device has no news. A force that is not finite or below 0 is no
        /// measurement either.</param>
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
            // Not "above": a time that is not a number ends the hold as well.
            if (Verdict != ForceVerdict.Unknown && !(timeSeconds - measuredSeconds <= Settings.HoldSeconds))
            {
                Forget();
            }
            return Verdict;
        }

        /// <summary>A surface is near enough for a pressing tip to be on it.</summary>
        /// <param name="signedDistanceMetres">From the tip sphere to the surface, negative where it cuts in.</param>
        /// <param name="isTouched">It was touched a frame ago.</param>
        public bool IsNear(double signedDistanceMetres, bool isTouched) =>
            Math.Abs(signedDistanceMetres) <= Settings.NearMetres + (isTouched ? Settings.NearMarginMetres : 0.0);

        /// <summary>The pen was put away or given to another hand.</summary>
        public void Forget()
        {
            Verdict = ForceVerdict.Unknown;
            ForceNewtons = 0.0;
            measuredSeconds = double.NegativeInfinity;
        }
    }
}
