#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Until when outputs leave each hand's device to another vibration. Main thread; no garbage.</summary>
    internal static class HandYields
    {
        /// <summary>Limit of one call, in s: a mistaken length must not silence a hand for good.</summary>
        public const float MaximumSeconds = 60f;

        private static readonly double[] Until = new double[Enum.GetValues(typeof(HapticHand)).Length];

        /// <summary>See <see cref="Haptics.Yield"/>.</summary>
        public static void Yield(HapticHand hand, float seconds)
        {
            if (!(seconds > 0f))
            {
                return;
            }
            double until = Time.realtimeSinceStartupAsDouble + Math.Min(seconds, MaximumSeconds);
            for (int each = 0; each < Until.Length; ++each)
            {
                if (hand == HapticHand.None || each == (int)hand)
                {
                    Until[each] = Math.Max(Until[each], until);
                }
            }
        }

        /// <summary>The <see cref="Time.realtimeSinceStartupAsDouble"/> until which outputs of a hand yield.</summary>
        public static double UntilSeconds(HapticHand hand) => Until[(int)hand];

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Forget() => Array.Clear(Until, 0, Until.Length);
    }
}
