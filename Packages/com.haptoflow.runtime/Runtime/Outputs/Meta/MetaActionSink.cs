#nullable enable
using HaptoFlow.Outputs;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>The motor of an MX Ink through Meta's SDK: OVRPlugin.TriggerVibrationAction, with the action that
    /// Logitech's action set binds to the pen's haptic output.</summary>
    internal sealed class MetaActionSink : IAmplitudeSink
    {
        private const string Action = "haptic_pulse";
        private const float MinimumSeconds = 0.001f;

        private readonly MetaController controller;

        public MetaActionSink(HapticHand hand) => controller = new MetaController(hand);

        public string Name => "MX Ink";

        public bool TryGetCapabilities(out HapticSinkCapabilities capabilities)
        {
            capabilities = new HapticSinkCapabilities(0.0);
            return controller.HoldsMxInk;
        }

        public bool Submit(float amplitude, float frequencyHz, float durationSeconds)
        {
            bool done = OVRPlugin.TriggerVibrationAction(Action, controller.Hand, durationSeconds, amplitude);
            if (!done)
            {
                controller.Fail();
                Debug.LogWarning($"HaptoFlow: MX Ink does not vibrate: Meta's SDK has no haptic action \"{Action}\" " +
                    "that is bound to the pen (Project Settings > Meta XR > Input Actions). HaptoFlow tries again " +
                    "when the session or the controllers change.");
            }
            return done;
        }

        public void Stop()
        {
            if (controller.HoldsMxInk)
            {
                Submit(0f, 0f, MinimumSeconds);
            }
        }

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Register() => HapticSinks.Register(
            "Meta MX Ink", HapticForm.Amplitude, 30, hand => new MetaActionSink(hand));
    }
}
