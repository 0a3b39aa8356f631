#nullable enable
using System;
using HaptoFlow.Outputs;
using UnityEngine;
using UnityEngine.InputSystem;
using UnityEngine.Scripting;
using UnityEngine.XR.OpenXR.Input;

// No scene references this assembly, which registers device routes when it is loaded.
[assembly: AlwaysLinkAssembly]

namespace HaptoFlow
{
    /// <summary>The motor of the OpenXR device in a hand, MX Ink included: OpenXRInput.SendHapticImpulse on an action
    /// bound to the device's haptic output.</summary>
    internal sealed class OpenXrSink : IAmplitudeSink, IDisposable
    {
        private const double CheckIntervalSeconds = 0.5;

        // OpenXR accepts any frequency, and the runtime plays the nearest that the device supports.
        private const double MinimumHz = 60.0;
        private const double MaximumHz = 400.0;

        private readonly InputAction action;
        private bool isBound;
        private double nextCheckSeconds = double.NegativeInfinity;

        public OpenXrSink(HapticHand hand)
        {
            Name = $"the OpenXR device in the {hand} hand";
            action = new InputAction(type: InputActionType.PassThrough,
                binding: "<XRController>{" + hand + "Hand}/haptic");
            action.Enable();
        }

        public string Name { get; }

        public bool TryGetCapabilities(out HapticSinkCapabilities capabilities)
        {
            capabilities = new HapticSinkCapabilities(0.0, minFrequencyHz: MinimumHz, maxFrequencyHz: MaximumHz);
            double seconds = Time.realtimeSinceStartupAsDouble;
            if (seconds >= nextCheckSeconds)
            {
                nextCheckSeconds = seconds + CheckIntervalSeconds;
                isBound = action.controls.Count > 0 && OpenXRInput.GetActionHandle(action) != 0uL;
            }
            return isBound;
        }

        public bool Submit(float amplitude, float frequencyHz, float durationSeconds)
        {
            OpenXRInput.SendHapticImpulse(action, amplitude, frequencyHz, durationSeconds);
            return true;
        }

        public void Stop() => OpenXRInput.StopHaptics(action);

        public void Dispose() => action.Dispose();

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Register() => HapticSinks.Register(
            "OpenXR impulse", HapticForm.Amplitude, 10, hand => new OpenXrSink(hand));
    }
}
