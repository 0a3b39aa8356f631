using System.Collections.Generic;
using UnityEngine;
using UnityEngine.XR;

namespace UnityShim
{
    /// <summary>The screen, and the headset's display where there is one.</summary>
    public static class Displays
    {
        internal static readonly List<ISubsystem> Subsystems = new List<ISubsystem>();

        /// <summary>0 over 0 for one that does not say, as without a window.</summary>
        public static RefreshRate Screen { get; set; }

        /// <summary>A headset whose display runs.</summary>
        /// <param name="refreshRateHz">Null for a display that does not say.</param>
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
