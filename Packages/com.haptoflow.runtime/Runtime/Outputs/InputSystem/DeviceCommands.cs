#nullable enable
using UnityEngine;
using UnityEngine.InputSystem;
using UnityEngine.InputSystem.LowLevel;
using UnityEngine.InputSystem.Utilities;
using UnityEngine.InputSystem.XR;
using UnityEngine.InputSystem.XR.Haptics;
using UnityEngine.Scripting;

// No scene references this assembly, which registers device routes when it is loaded.
[assembly: AlwaysLinkAssembly]

namespace HaptoFlow
{
    /// <summary>Sees the impulses that others send to a controller through the Input System, such as the XR Interaction
    /// Toolkit, and lets outputs in that hand yield to them.</summary>
    internal static class DeviceCommands
    {
        // Of the command's data: channel (int), amplitude (float), duration in s (float).
        private const int AmplitudeOffset = sizeof(int);
        private const int DurationOffset = sizeof(int) + sizeof(float);

        private static readonly FourCC Impulse = SendHapticImpulseCommand.Create(0, 0f, 0f).typeStatic;
        private static bool isOwn;

        /// <summary>Sends an impulse of HaptoFlow's own.</summary>
        public static void Send(XRControllerWithRumble controller, float amplitude, float durationSeconds)
        {
            isOwn = true;
            try
            {
                controller.SendImpulse(amplitude, durationSeconds);
            }
            finally
            {
                isOwn = false;
            }
        }

        // Returns null: the command goes on to the device.
        private static unsafe long? OnCommand(InputDevice device, InputDeviceCommand* command)
        {
            if (!isOwn && command->type == Impulse)
            {
                byte* data = (byte*)command->payloadPtr;
                if (*(float*)(data + AmplitudeOffset) > 0f)
                {
                    Yield(device, *(float*)(data + DurationOffset));
                }
            }
            return null;
        }

        private static void Yield(InputDevice device, float seconds)
        {
            if (ReferenceEquals(device, XRController.leftHand))
            {
                Haptics.Yield(HapticHand.Left, seconds);
            }
            else if (ReferenceEquals(device, XRController.rightHand))
            {
                Haptics.Yield(HapticHand.Right, seconds);
            }
        }

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.BeforeSceneLoad)]
        private static unsafe void Watch()
        {
            // Without a domain reload this runs again in each play mode.
            InputSystem.onDeviceCommand -= OnCommand;
            InputSystem.onDeviceCommand += OnCommand;
        }
    }
}
