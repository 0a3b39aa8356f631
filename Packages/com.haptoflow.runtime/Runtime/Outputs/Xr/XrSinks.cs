#nullable enable
#if HAPTOFLOW_XR
using System;
using HaptoFlow.Outputs;
using UnityEngine;
using UnityEngine.XR;

namespace HaptoFlow
{
    /// <summary>The motor of any XR controller: SendHapticImpulse.</summary>
    internal sealed class XrImpulseSink : IAmplitudeSink
    {
        private readonly XrDevice device;

        public XrImpulseSink(HapticHand hand) => device = new XrDevice(hand);

        public string Name => device.Name;

        public bool TryGetCapabilities(out HapticSinkCapabilities capabilities)
        {
            capabilities = new HapticSinkCapabilities(0.0);
            return device.TryGetCapabilities(out HapticCapabilities reported) && reported.supportsImpulse &&
                reported.numChannels > 0;
        }

        public bool Submit(float amplitude, float frequencyHz, float durationSeconds) =>
            device.Device.SendHapticImpulse(0u, amplitude, durationSeconds);

        public void Stop() => device.Device.StopHaptics();

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Register() => HapticSinks.Register(
            "XR impulse", HapticForm.Amplitude, 0, hand => new XrImpulseSink(hand));
    }

    /// <summary>Any XR controller that supports buffers: SendHapticBuffer. Unity leaves the format to the device; the
    /// bytes are magnitudes, 0 to 255, as Oculus defined them.</summary>
    internal sealed class XrBufferSink : IWaveformSink
    {
        // After this many failures in a row, a device that reports buffers is treated as one without.
        private const int MaximumRefusals = 3;

        private readonly XrDevice device;
        private readonly ArraysByLength<byte> buffers = new ArraysByLength<byte>();
        private InputDevice refusing;
        private int refusals;

        public XrBufferSink(HapticHand hand) => device = new XrDevice(hand);

        public string Name => device.Name;

        public bool ReplacesWithoutGap => false;

        public bool TryGetCapabilities(out HapticSinkCapabilities capabilities)
        {
            bool supportsBuffers = device.TryGetCapabilities(out HapticCapabilities reported) &&
                reported.supportsBuffer &&
                reported.bufferFrequencyHz > 0u && reported.bufferMaxSize > 0u && reported.numChannels > 0u;
            capabilities = new HapticSinkCapabilities(reported.bufferFrequencyHz,
                (int)Math.Min(reported.bufferMaxSize, 4000u));
            if (device.Device != refusing)
            {
                refusing = device.Device;
                refusals = 0;
            }
            return supportsBuffers && refusals < MaximumRefusals;
        }

        public int Submit(ReadOnlySpan<float> samples, bool replace)
        {
            if (replace)
            {
                device.Device.StopHaptics();
            }
            byte[] bytes = buffers.Of(samples.Length);
            for (int index = 0; index < bytes.Length; ++index)
            {
                bytes[index] = (byte)(255f * Math.Min(1f, Math.Abs(samples[index])) + 0.5f);
            }
            bool isTaken = device.Device.SendHapticBuffer(0u, bytes);
            refusals = isTaken ? 0 : refusals + 1;
            return isTaken ? bytes.Length : -1;
        }

        public void Stop() => device.Device.StopHaptics();

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Register() => HapticSinks.Register(
            "XR buffer", HapticForm.Waveform, 0, hand => new XrBufferSink(hand));
    }
}
#endif
