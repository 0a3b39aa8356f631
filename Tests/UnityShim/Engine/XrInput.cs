using System;
using System.Collections.Generic;
using UnityShim;

namespace UnityEngine.XR
{
    public enum XRNode
    {
        LeftHand = 4,
        RightHand = 5,
        GameController = 6,
    }

    [Flags]
    public enum InputDeviceCharacteristics : uint
    {
        None = 0,
        HeldInHand = 1 << 2,
        TrackedDevice = 1 << 5,
        Controller = 1 << 6,
        Left = 1 << 8,
        Right = 1 << 9,
    }

    public struct HapticCapabilities
    {
        public uint numChannels { get; internal set; }
        public bool supportsImpulse { get; internal set; }
        public bool supportsBuffer { get; internal set; }
        public uint bufferFrequencyHz { get; internal set; }
        public uint bufferMaxSize { get; internal set; }
    }

    public struct InputDevice : IEquatable<InputDevice>
    {
        private readonly XrHand? hand;
        private readonly int visit;

        internal InputDevice(XrHand hand)
        {
            this.hand = hand;
            visit = hand.Visit;
        }

        public bool isValid => hand is { IsThere: true } && hand.Visit == visit;
        public string name => hand?.Name ?? "";

        public bool TryGetHapticCapabilities(out HapticCapabilities capabilities)
        {
            capabilities = isValid ? hand!.Capabilities : default;
            return isValid;
        }

        public bool SendHapticImpulse(uint channel, float amplitude, float duration = 1f)
        {
            if (amplitude < 0f || duration < 0f)
            {
                throw new ArgumentException("amplitude and duration of SendHapticImpulse cannot be negative");
            }
            return isValid && hand!.Impulse(amplitude, duration);
        }

        public bool SendHapticBuffer(uint channel, byte[] buffer) => isValid && hand!.Buffer(buffer);

        public void StopHaptics()
        {
            if (isValid)
            {
                hand!.Stop();
            }
        }

        public override bool Equals(object? obj) => obj is InputDevice other && Equals(other);

        public bool Equals(InputDevice other) => ReferenceEquals(hand, other.hand) && visit == other.visit;

        public override int GetHashCode() => visit;

        public static bool operator ==(InputDevice a, InputDevice b) => a.Equals(b);

        public static bool operator !=(InputDevice a, InputDevice b) => !a.Equals(b);
    }

    public partial class InputDevices
    {
        public static InputDevice GetDeviceAtXRNode(XRNode node) => new InputDevice(
            node == XRNode.LeftHand ? XrHand.Left : XrHand.Right);
    }

    public class XRDisplaySubsystemDescriptor : IntegratedSubsystemDescriptor<XRDisplaySubsystem>
    {
    }

    public class XRDisplaySubsystem : IntegratedSubsystem<XRDisplaySubsystemDescriptor>
    {
        internal float? RefreshRateHz;

        public bool TryGetDisplayRefreshRate(out float displayRefreshRate)
        {
            displayRefreshRate = RefreshRateHz ?? 0f;
            return RefreshRateHz.HasValue;
        }
    }
}

namespace UnityEngine
{
    public struct RefreshRate
    {
        public uint numerator;
        public uint denominator;

        public double value => (double)numerator / denominator;
    }

    public struct Resolution
    {
        public int width { get; set; }
        public int height { get; set; }
        public RefreshRate refreshRateRatio { get; set; }
    }

    public sealed partial class Screen
    {
        public static Resolution currentResolution
        {
            get
            {
                World.RequireMainThread();
                return new Resolution { width = 1920, height = 1080, refreshRateRatio = Displays.Screen };
            }
        }
    }

    public interface ISubsystem
    {
    }

    public interface ISubsystemDescriptor
    {
    }

    public class IntegratedSubsystem : ISubsystem
    {
        public bool running { get; private set; }

        public void Start() => running = true;

        public void Stop() => running = false;
    }

    public partial class IntegratedSubsystem<TSubsystemDescriptor> : IntegratedSubsystem
        where TSubsystemDescriptor : ISubsystemDescriptor
    {
    }

    public abstract class IntegratedSubsystemDescriptor : ISubsystemDescriptor
    {
    }

    public class IntegratedSubsystemDescriptor<TSubsystem> : IntegratedSubsystemDescriptor
        where TSubsystem : IntegratedSubsystem
    {
    }

    public static partial class SubsystemManager
    {
        public static void GetSubsystems<T>(List<T> subsystems)
            where T : ISubsystem
        {
            subsystems.Clear();
            foreach (ISubsystem each in Displays.Subsystems)
            {
                if (each is T found)
                {
                    subsystems.Add(found);
                }
            }
        }
    }
}
