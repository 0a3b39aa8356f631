using System.Collections.Generic;
using UnityEngine.InputSystem;
using UnityShim;

namespace UnityEngine.XR.OpenXR.Input
{
    /// <summary>Part of Unity's OpenXR package.</summary>
    public static class OpenXRInput
    {
        internal static ulong Handle;

        internal static List<(double Seconds, float Amplitude, float FrequencyHz, float Duration)> Impulses { get; } =
            new List<(double, float, float, float)>();

        internal static int Stops { get; private set; }

        public static ulong GetActionHandle(InputAction inputAction, InputSystem.InputDevice? inputDevice = null) => Handle;

        public static void SendHapticImpulse(InputAction action, float amplitude, float frequency, float duration,
            InputSystem.InputDevice? inputDevice = null) =>
            Impulses.Add((Clock.UnscaledSeconds, amplitude, frequency, duration));

        public static void StopHaptics(InputAction inputAction, InputSystem.InputDevice? inputDevice = null) => ++Stops;

        internal static void Reset()
        {
            Handle = 0uL;
            Impulses.Clear();
            Stops = 0;
        }
    }
}
