#nullable enable
using HaptoFlow.Outputs;
#if HAPTOFLOW_INPUT_SYSTEM
using UnityEngine;
using UnityEngine.InputSystem;
#endif

namespace HaptoFlow.Editor
{
    /// <summary>The motors of gamepads, where the Input System is installed.</summary>
    internal static class GamepadSinks
    {
#if HAPTOFLOW_INPUT_SYSTEM
        public const bool IsSupported = true;

        public static void Open(HeldDevice into) => into.Add(HapticForm.Amplitude, new GamepadSink());
#else
        public const bool IsSupported = false;

        public static void Open(HeldDevice into)
        {
        }
#endif
    }

#if HAPTOFLOW_INPUT_SYSTEM
    /// <summary>The two motors of the gamepad that was used last: Gamepad.SetMotorSpeeds. They run until they get another
    /// speed, so that whoever submits must stop them.</summary>
    internal sealed class GamepadSink : IAmplitudeSink
    {
        // Pads connected by USB or Bluetooth lose reports that come much faster.
        private const double SubmissionsPerSecond = 60.0;

        // A heavy mass turns slowly and a light one fast. Pads do not report how fast; these are guesses.
        private const float HeavyMotorHz = 60f;
        private const float LightMotorHz = 240f;

        private Gamepad? vibrating;

        public string Name => Gamepad.current?.displayName ?? "a gamepad";

        public bool TryGetCapabilities(out HapticSinkCapabilities capabilities)
        {
            capabilities = new HapticSinkCapabilities(SubmissionsPerSecond, minFrequencyHz: HeavyMotorHz,
                maxFrequencyHz: LightMotorHz);
            return Gamepad.current != null;
        }

        public bool Submit(float amplitude, float frequencyHz, float durationSeconds)
        {
            Gamepad? pad = Gamepad.current;
            if (!ReferenceEquals(pad, vibrating))
            {
                Stop();
                vibrating = pad;
            }
            float light = Mathf.Clamp01((frequencyHz - HeavyMotorHz) / (LightMotorHz - HeavyMotorHz));
            pad?.SetMotorSpeeds((1f - light) * amplitude, light * amplitude);
            return pad != null;
        }

        public void Stop()
        {
            vibrating?.SetMotorSpeeds(0f, 0f);
            vibrating = null;
        }
    }
#endif
}
