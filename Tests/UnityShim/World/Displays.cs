using System.Collections.Generic;
using UnityEngine;
using UnityEngine.XR;

namespace UnityShim
{
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
