#nullable enable
#if HAPTOFLOW_META_VIBRATION
using HaptoFlow.Outputs;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>The motor of an MX Ink through Meta's SDK: OVRPlugin.TriggerVibrationAction, with the action that
    /// Logitech's action set binds to the pen's haptic output. The call exists from version 68.0.2 of the SDK; with an
    /// older one the routes of OpenXR and Unity's XR devices are used.</summary>
    internal sealed class MetaActionSink : IAmplitudeSink
    {
        private const string Action = "haptic_pulse";
        private const float MinimumSeconds = 0.001f;

        private readonly MetaController controller;

        // The SDK logs an error for every failing call.
        public MetaActionSink(HapticHand hand) => controller = new MetaController(hand, 2.0);

        public string Name => "MX Ink";

        public bool TryGetCapabilities(out HapticSinkCapabilities capabilities)
        {
            capabilities = new HapticSinkCapabilities(0.0);
            return controller.HoldsMxInk;
        }

        public bool Submit(float amplitude, float frequencyHz, float durationSeconds)
        {
            bool done = OVRPlugin.TriggerVibrationAction(Action, controller.Hand, durationSeconds, amplitude);
            if (done)
            {
                controller.Succeed();
            }
            else if (controller.Fail())
            {
                Debug.LogWarning($"HaptoFlow: MX Ink does not vibrate by Meta's SDK, which has no haptic action " +
                    $"\"{Action}\" that is bound to the pen. Use the action set of Logitech's integration package " +
                    "(logitech.github.io/mxink) under Project Settings > Meta XR > Input Actions. HaptoFlow tries again, " +
                    "less and less often, and meanwhile uses the next route to the pen.");
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
#endif
