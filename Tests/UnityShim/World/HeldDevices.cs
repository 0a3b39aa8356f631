using System.Collections.Generic;
using UnityEngine.InputSystem;
using UnityEngine.InputSystem.XR;
using UnityEngine.XR;
using UnityEngine.XR.OpenXR.Input;

namespace UnityShim
{
    /// <summary>The devices in both hands, for all packages that support controllers.</summary>
    public static class HeldDevices
    {
        /// <summary>Empties both hands and clears the recorded output.</summary>
        public static void Reset()
        {
            OVRPlugin.Reset();
            OVRInput.Reset();
            OpenXRInput.Reset();
            OpenXrRuntime.Reset();
            XrHand.Reset();
            XRControllerWithRumble.Drop();
            Gamepad.current = null;
        }

        /// <summary>Puts a Touch controller into the right hand that supports waveforms, and parametric haptics from 60
        /// to 400 Hz.</summary>
        public static void TakeTouchController()
        {
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            OVRInput.Properties = new OVRInput.HapticsParametricProperties
            {
                IdealFrameSubmissionRate = 20000000L,
                MinimumFirstFrameDuration = 40000000L,
                MinFrequencyHz = 60f,
                MaxFrequencyHz = 400f,
            };
        }
    }

    /// <summary>A tracked device in a hand, and the haptics that it received.</summary>
    public sealed class XrHand
    {
        private bool isThere;

        private XrHand()
        {
        }

        public static XrHand Left { get; } = new XrHand();

        public static XrHand Right { get; } = new XrHand();

        public string Name { get; set; } = "";

        public HapticCapabilities Capabilities { get; private set; }

        /// <summary>The number of devices connected so far.</summary>
        public int Visit { get; private set; }

        public bool IsThere
        {
            get => isThere;
            set
            {
                isThere = value;
                Visit += value ? 1 : 0;
            }
        }

        public List<(double Seconds, float Amplitude, float Duration)> Impulses { get; } =
            new List<(double, float, float)>();

        public List<(double Seconds, byte[] Bytes)> Buffers { get; } = new List<(double, byte[])>();

        public List<double> Stops { get; } = new List<double>();

        /// <summary>The device reports that it accepts buffers, but refuses them.</summary>
        public bool RefusesBuffers { get; set; }

        public static void Reset()
        {
            foreach (XrHand hand in new[] { Left, Right })
            {
                hand.IsThere = false;
                hand.RefusesBuffers = false;
                hand.Capabilities = default;
                hand.Impulses.Clear();
                hand.Buffers.Clear();
                hand.Stops.Clear();
            }
        }

        /// <summary>Connects a device, in place of a previous one.</summary>
        public void Take(string name, bool impulses, uint bufferFrequencyHz = 0u)
        {
            Name = name;
            Capabilities = new HapticCapabilities
            {
                numChannels = 1u,
                supportsImpulse = impulses,
                supportsBuffer = bufferFrequencyHz > 0u,
                bufferFrequencyHz = bufferFrequencyHz,
                bufferMaxSize = bufferFrequencyHz > 0u ? 256u : 0u,
            };
            IsThere = true;
        }

        internal bool Impulse(float amplitude, float duration)
        {
            Impulses.Add((Clock.UnscaledSeconds, amplitude, duration));
            return true;
        }

        internal bool Buffer(byte[] bytes)
        {
            Buffers.Add((Clock.UnscaledSeconds, (byte[])bytes.Clone()));
            return !RefusesBuffers && bytes.Length <= Capabilities.bufferMaxSize;
        }

        internal void Stop() => Stops.Add(Clock.UnscaledSeconds);
    }
}
