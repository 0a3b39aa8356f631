using System.Collections.Generic;
using UnityEngine.InputSystem.Controls;
using UnityEngine.InputSystem.Layouts;
using UnityEngine.InputSystem.LowLevel;
using UnityEngine.InputSystem.XR.Haptics;
using UnityShim;

namespace UnityEngine.InputSystem
{
    public class TrackedDevice : InputDevice
    {
        [InputControl]
        public IntegerControl trackingState { get; private set; } = null!;

        [InputControl]
        public ButtonControl isTracked { get; private set; } = null!;

        [InputControl]
        public Vector3Control devicePosition { get; private set; } = null!;

        [InputControl]
        public QuaternionControl deviceRotation { get; private set; } = null!;
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

        public void SendImpulse(float amplitude, float duration)
        {
            SendHapticImpulseCommand command = SendHapticImpulseCommand.Create(0, amplitude, duration);
            ExecuteCommand(ref command);
        }

        internal static XRControllerWithRumble Take(string name)
        {
            var taken = new XRControllerWithRumble { displayName = name };
            Right = taken;
            return taken;
        }

        internal static XRControllerWithRumble TakeLeft(string name)
        {
            var taken = new XRControllerWithRumble { displayName = name };
            Left = taken;
            return taken;
        }

        internal static void Drop()
        {
            Left = null;
            Right = null;
        }

        private protected override unsafe void Receive(InputDeviceCommand* command)
        {
            if (command->type == SendHapticImpulseCommand.Create(0, 0f, 0f).typeStatic)
            {
                float* data = (float*)command->payloadPtr;
                Impulses.Add((Clock.UnscaledSeconds, data[1], data[2]));
            }
        }
    }
}
