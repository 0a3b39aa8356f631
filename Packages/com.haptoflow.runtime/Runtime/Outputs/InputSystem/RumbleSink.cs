#nullable enable
using HaptoFlow.Outputs;
using UnityEngine;
using UnityEngine.InputSystem.XR;

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
}
