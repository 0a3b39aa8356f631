#nullable enable
using UnityEngine;
#if HAPTOFLOW_XR
using System.Collections.Generic;
using UnityEngine.XR;
#endif

namespace HaptoFlow
{
    /// <summary>The refresh rate of the display, in Hz. Main thread; makes garbage.</summary>
    internal static class DisplayRate
    {
        private const double MinimumHz = 1.0;
        private const double MaximumHz = 1000.0;

        /// <summary>The rate of the running headset, else of the screen.</summary>
        /// <returns>False where neither reports a rate; <paramref name="hertz"/> is then 0.</returns>
        public static bool TryGet(out double hertz) => TryGetHeadset(out hertz) || TryGetScreen(out hertz);

        private static bool TryGetHeadset(out double hertz)
        {
#if HAPTOFLOW_XR
            var displays = new List<XRDisplaySubsystem>();
            SubsystemManager.GetSubsystems(displays);
            foreach (XRDisplaySubsystem display in displays)
            {
                if (display.running && display.TryGetDisplayRefreshRate(out float rate) && IsUsable(rate))
                {
                    hertz = rate;
                    return true;
                }
            }
#endif
            hertz = 0.0;
            return false;
        }

        private static bool TryGetScreen(out double hertz)
        {
            double rate = Screen.currentResolution.refreshRateRatio.value;
            hertz = IsUsable(rate) ? rate : 0.0;
            return hertz > 0.0;
        }

        private static bool IsUsable(double rate) => rate >= MinimumHz && rate <= MaximumHz;
    }
}
