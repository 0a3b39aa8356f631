#nullable enable
#if HAPTOFLOW_XR
using UnityEngine;
using UnityEngine.XR;

namespace HaptoFlow
{
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
