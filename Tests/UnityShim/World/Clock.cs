using System.Collections.Generic;
using UnityEngine;
using UnityEngine.XR;

namespace UnityShim
{
    /// <summary>Unity's clocks for frames and for the fixed steps between them.</summary>
    public static class Clock
    {
        public static double Seconds { get; private set; }
        public static double UnscaledSeconds { get; private set; }
        public static double DeltaSeconds { get; private set; }
        public static double UnscaledDeltaSeconds { get; private set; }
        public static double FixedSeconds { get; private set; }
        /// <summary>The unscaled time of the last fixed step.</summary>
        public static double FixedUnscaledSeconds =>
            Scale > 0.0 ? UnscaledSeconds - (Seconds - FixedSeconds) / Scale : UnscaledSeconds;

        public static double FixedStepSeconds { get; set; } = 0.02;
        public static double Scale { get; set; } = 1.0;
        public static int Frames { get; private set; }
        public static bool InFixedStep { get; internal set; }

        internal static void Reset()
        {
            Seconds = 0.0;
            UnscaledSeconds = 0.0;
            FixedSeconds = 0.0;
            DeltaSeconds = 0.0;
            UnscaledDeltaSeconds = 0.0;
            FixedStepSeconds = 0.02;
            Scale = 1.0;
            Frames = 0;
            InFixedStep = false;
        }

        internal static void NextFrame(double seconds)
        {
            UnscaledDeltaSeconds = seconds;
            DeltaSeconds = seconds * Scale;
            UnscaledSeconds += seconds;
            Seconds += DeltaSeconds;
            ++Frames;
        }

        /// <summary>Whether another fixed step is due before this frame. If so, advances to it.</summary>
        internal static bool NextFixedStep()
        {
            bool due = FixedSeconds + FixedStepSeconds <= Seconds + 1e-9;
            if (due)
            {
                FixedSeconds += FixedStepSeconds;
            }
            return due;
        }
    }

    /// <summary>The screen, and the display of a headset if there is one.</summary>
    public static class Displays
    {
        internal static readonly List<ISubsystem> Subsystems = new List<ISubsystem>();

        /// <summary>The refresh rate of the screen; 0/0 if it is unknown, as without a window.</summary>
        public static RefreshRate Screen { get; set; }

        /// <summary>Adds a headset with a running display.</summary>
        /// <param name="refreshRateHz">The refresh rate; null if the display does not report it.</param>
        public static XRDisplaySubsystem Wear(float? refreshRateHz)
        {
            var display = new XRDisplaySubsystem { RefreshRateHz = refreshRateHz };
            display.Start();
            Subsystems.Add(display);
            return display;
        }

        public static void Reset()
        {
            Screen = default;
            Subsystems.Clear();
        }
    }
}
