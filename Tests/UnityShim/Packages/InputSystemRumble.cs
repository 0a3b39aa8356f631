using System.Collections.Generic;
using UnityShim;

namespace UnityEngine.InputSystem
{
    public class TrackedDevice : InputDevice
    {
    }
}

namespace UnityEngine.InputSystem.XR
{
    public class XRController : TrackedDevice
    {
        internal static XRController? Left;
        internal static XRController? Right;

        public static XRController? leftHand => Left;

        public static XRController? rightHand => Right;
    }

    public class XRControllerWithRumble : XRController
    {
        internal List<(double Seconds, float Amplitude, float Duration)> Impulses { get; } =
            new List<(double, float, float)>();

        public void SendImpulse(float amplitude, float duration) =>
            Impulses.Add((Clock.UnscaledSeconds, amplitude, duration));

        internal static XRControllerWithRumble Take(string name)
        {
            var taken = new XRControllerWithRumble { displayName = name };
            Right = taken;
            return taken;
        }

        internal static void Drop() => Right = null;
    }
}
