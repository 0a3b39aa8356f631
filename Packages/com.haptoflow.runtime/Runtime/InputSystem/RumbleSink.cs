#if HAPTOFLOW_XR && ENABLE_VR
#nullable enable
using HaptoFlow.Outputs;
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
    /// <summary>The motor of a controller in the Input System: XRControllerWithRumble.SendImpulse.</summary>
    internal sealed class RumbleSink : IAmplitudeSink
    {
        private readonly bool isLeft;

        public RumbleSink(HapticHand hand) => isLeft = hand == HapticHand.Left;

        public string Name => Controller()?.displayName ?? "a controller with rumble";

        public bool TryGetCapabilities(out HapticSinkCapabilities capabilities)
        {
            capabilities = new HapticSinkCapabilities(0.0);
            return Controller() != null;
        }

        public bool Submit(float amplitude, float frequencyHz, float durationSeconds)
        {
            XRControllerWithRumble? controller = Controller();
            if (controller == null)
            {
                return false;
            }
            DeviceCommands.Send(controller, amplitude, durationSeconds);
            return true;
        }

        public void Stop() => Submit(0f, 0f, 0f);

        private XRControllerWithRumble? Controller() =>
            (isLeft ? XRController.leftHand : XRController.rightHand) as XRControllerWithRumble;

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Register() => HapticSinks.Register(
            "Input System rumble", HapticForm.Amplitude, -10, hand => new RumbleSink(hand));
    }

    /// <summary>Sees the impulses that others send to a controller through the Input System, such as the XR Interaction
    /// Toolkit, and lets outputs in that hand yield to them.</summary>
    internal static class DeviceCommands
    {
        // Of the command's data: channel (int), amplitude (float), duration in s (float).
        private const int AmplitudeOffset = sizeof(int);
        private const int DurationOffset = sizeof(int) + sizeof(float);

        private static readonly FourCC Impulse = SendHapticImpulseCommand.Create(0, 0f, 0f).typeStatic;
        private static bool isOwn;

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
#endif
