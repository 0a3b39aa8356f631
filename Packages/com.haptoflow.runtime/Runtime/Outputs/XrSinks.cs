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
        private readonly XrDevice device;
        private readonly ArraysByLength<byte> buffers = new ArraysByLength<byte>();
        private readonly RetryDelay retry = new RetryDelay(0.05, 30.0);
        private InputDevice known;

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
            if (device.Device != known)
            {
                known = device.Device;
                retry.Restart();
            }
            return supportsBuffers && retry.IsDue(Time.realtimeSinceStartupAsDouble);
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
            if (device.Device.SendHapticBuffer(0u, bytes))
            {
                retry.Forget();
                return bytes.Length;
            }
            Refuse();
            return -1;
        }

        private void Refuse()
        {
            if (retry.Fail(Time.realtimeSinceStartupAsDouble))
            {
                Debug.LogWarning($"HaptoFlow: {Name} reports that it plays waveforms, but refused one. HaptoFlow tries " +
                    "again, less and less often, and meanwhile uses the next route to it.");
            }
        }

        public void Stop() => device.Device.StopHaptics();

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Register() => HapticSinks.Register(
            "XR buffer", HapticForm.Waveform, 0, hand => new XrBufferSink(hand));
    }

    /// <summary>The device that Unity tracks in a hand and its haptic capabilities, refreshed several times a second.
    /// Main thread; no garbage.</summary>
    internal sealed class XrDevice
    {
        private const double QueryIntervalSeconds = 0.25;

        private readonly XRNode node;
        private HapticCapabilities capabilities;
        private bool hasHaptics;
        private double nextQuerySeconds = double.NegativeInfinity;

        public XrDevice(HapticHand hand) => node = hand == HapticHand.Left ? XRNode.LeftHand : XRNode.RightHand;

        public string Name { get; private set; } = "an XR device";

        public InputDevice Device { get; private set; }

        /// <returns>False while no device with haptics is connected.</returns>
        public bool TryGetCapabilities(out HapticCapabilities now)
        {
            double seconds = Time.realtimeSinceStartupAsDouble;
            if (seconds >= nextQuerySeconds || (hasHaptics && !Device.isValid))
            {
                nextQuerySeconds = seconds + QueryIntervalSeconds;
                Query();
            }
            now = capabilities;
            return hasHaptics;
        }

        private void Query()
        {
            InputDevice before = Device;
            Device = InputDevices.GetDeviceAtXRNode(node);
            hasHaptics = Device.isValid && Device.TryGetHapticCapabilities(out capabilities);
            if (hasHaptics && Device != before)
            {
                Name = Device.name;
            }
        }
    }
}
#endif
