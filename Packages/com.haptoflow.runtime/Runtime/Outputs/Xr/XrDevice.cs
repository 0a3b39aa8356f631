#nullable enable
#if HAPTOFLOW_XR
using UnityEngine;
using UnityEngine.XR;

namespace HaptoFlow
{
    /// <summary>What Unity tracks in a hand, and what it says of its haptics: asked when it comes, and some times a
    /// second as long as nothing is there or it may have become another. Main thread; no garbage.</summary>
    internal sealed class XrDevice
    {
        private const double AskSeconds = 0.25;

        private readonly XRNode node;
        private InputDevice device;
        private HapticCapabilities capabilities;
        private bool hasHaptics;
        private double askAtSeconds = double.NegativeInfinity;

        public XrDevice(HapticHand hand) => node = hand == HapticHand.Left ? XRNode.LeftHand : XRNode.RightHand;

        public string Name { get; private set; } = "an XR device";

        public InputDevice Device => device;

        /// <returns>False while nothing is there that has haptics.</returns>
        public bool TryGetCapabilities(out HapticCapabilities now)
        {
            double seconds = Time.realtimeSinceStartupAsDouble;
            if (seconds >= askAtSeconds || (hasHaptics && !device.isValid))
            {
                askAtSeconds = seconds + AskSeconds;
                Ask();
            }
            now = capabilities;
            return hasHaptics;
        }

        private void Ask()
        {
            InputDevice before = device;
            device = InputDevices.GetDeviceAtXRNode(node);
            hasHaptics = device.isValid && device.TryGetHapticCapabilities(out capabilities);
            if (hasHaptics && device != before)
            {
                Name = device.name;
            }
        }
    }
}
#endif
