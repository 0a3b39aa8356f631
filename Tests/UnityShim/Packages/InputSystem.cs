using System;
using System.Collections.Generic;
using System.Linq;
using System.Runtime.InteropServices;
using System.Text.RegularExpressions;
using UnityEngine.InputSystem.Controls;
using UnityEngine.InputSystem.Layouts;
using UnityEngine.InputSystem.LowLevel;
using UnityEngine.InputSystem.Utilities;
using UnityEngine.InputSystem.XR.Haptics;
using UnityShim;

namespace UnityEngine.InputSystem
{
    public sealed partial class InputAction
    {
        internal float Value;

        public bool enabled { get; private set; }

        public void Enable() => enabled = true;

        public void Disable() => enabled = false;

        public TValue ReadValue<TValue>()
            where TValue : struct => enabled && (ReadBinding() ?? Value) is TValue value ? value : default;
    }

    public class InputActionReference : ScriptableObject
    {
        public InputAction action { get; } = new InputAction();
    }

    public struct InputActionProperty
    {
        private readonly InputAction? own;

        public InputActionProperty(InputAction action)
        {
            own = action;
            reference = null;
        }

        public InputActionReference? reference { get; }

        public InputAction? action => reference != null ? reference.action : own;
    }

    public static partial class InputSystem
    {
        internal static InputDeviceCommandDelegate? Watchers;

        /// <summary>Called for each command before its device gets it; a watcher that returns a value answers in the
        /// device's place.</summary>
        public static event InputDeviceCommandDelegate onDeviceCommand
        {
            add => Watchers += value;
            remove => Watchers -= value;
        }
    }

    public class InputDevice : InputControl
    {
        public unsafe long ExecuteCommand<TCommand>(ref TCommand command)
            where TCommand : struct, IInputDeviceCommandInfo
        {
            fixed (byte* bytes = MemoryMarshal.AsBytes(MemoryMarshal.CreateSpan(ref command, 1)))
            {
                return Execute((InputDeviceCommand*)bytes);
            }
        }

        private unsafe long Execute(InputDeviceCommand* command)
        {
            foreach (Delegate watcher in InputSystem.Watchers?.GetInvocationList() ?? Array.Empty<Delegate>())
            {
                long? answer = ((InputDeviceCommandDelegate)watcher)(this, command);
                if (answer.HasValue)
                {
                    return answer.Value;
                }
            }
            Receive(command);
            return InputDeviceCommand.GenericSuccess;
        }

        private protected virtual unsafe void Receive(InputDeviceCommand* command)
        {
        }
    }

    public class Gamepad : InputDevice
    {
        public static Gamepad? current { get; internal set; }

        internal List<(double Seconds, float Low, float High)> Speeds { get; } =
            new List<(double, float, float)>();

        internal Gamepad(string name) => displayName = name;

        public virtual void SetMotorSpeeds(float lowFrequency, float highFrequency) =>
            Speeds.Add((Clock.UnscaledSeconds, Mathf.Clamp01(lowFrequency), Mathf.Clamp01(highFrequency)));
    }

    public static partial class InputSystem
    {
        internal static Dictionary<string, (Type Type, InputDeviceMatcher Matches)> Layouts { get; } =
            new Dictionary<string, (Type, InputDeviceMatcher)>();

        public static void RegisterLayout(Type type, string? name = null, InputDeviceMatcher? matches = null) =>
            Layouts[name ?? type.Name] = (type, matches ?? default);

        public static void RemoveLayout(string name) => Layouts.Remove(name);
    }

    public class TrackedDevice : InputDevice
    {
        [InputControl]
        public IntegerControl trackingState { get; private set; } = null!;

        [InputControl]
        public ButtonControl isTracked { get; private set; } = null!;

        [InputControl]
        public Vector3Control devicePosition { get; private set; } = null!;

        [InputControl]
        public QuaternionControl deviceRotation { get; private set; } = null!;
    }
}

namespace UnityEngine.InputSystem.LowLevel
{
    public unsafe delegate long? InputDeviceCommandDelegate(InputDevice device, InputDeviceCommand* command);

    public interface IInputDeviceCommandInfo
    {
        FourCC typeStatic { get; }
    }

    [StructLayout(LayoutKind.Explicit, Size = BaseCommandSize)]
    public struct InputDeviceCommand : IInputDeviceCommandInfo
    {
        public const int BaseCommandSize = 8;
        public const long GenericSuccess = 1;

        [FieldOffset(0)]
        public FourCC type;

        [FieldOffset(4)]
        public int sizeInBytes;

        public InputDeviceCommand(FourCC type, int sizeInBytes = BaseCommandSize)
        {
            this.type = type;
            this.sizeInBytes = sizeInBytes;
        }

        public unsafe void* payloadPtr
        {
            get
            {
                fixed (InputDeviceCommand* start = &this)
                {
                    return (byte*)start + BaseCommandSize;
                }
            }
        }

        public FourCC typeStatic => type;
    }
}

namespace UnityEngine.InputSystem.Utilities
{
    public struct FourCC : IEquatable<FourCC>
    {
        private readonly int code;

        public FourCC(char a, char b = ' ', char c = ' ', char d = ' ') => code = (a << 24) | (b << 16) | (c << 8) | d;

        public bool Equals(FourCC other) => code == other.code;

        public override bool Equals(object obj) => obj is FourCC other && Equals(other);

        public override int GetHashCode() => code;

        public static bool operator ==(FourCC left, FourCC right) => left.code == right.code;

        public static bool operator !=(FourCC left, FourCC right) => left.code != right.code;
    }
}

namespace UnityEngine.InputSystem.XR.Haptics
{
    [StructLayout(LayoutKind.Explicit, Size = InputDeviceCommand.BaseCommandSize + 12)]
    public struct SendHapticImpulseCommand : IInputDeviceCommandInfo
    {
        [FieldOffset(0)]
        private InputDeviceCommand header;

        [FieldOffset(InputDeviceCommand.BaseCommandSize)]
        private int channel;

        [FieldOffset(InputDeviceCommand.BaseCommandSize + 4)]
        private float amplitude;

        [FieldOffset(InputDeviceCommand.BaseCommandSize + 8)]
        private float duration;

        public FourCC typeStatic => new FourCC('X', 'H', 'I', '0');

        public static SendHapticImpulseCommand Create(int motorChannel, float motorAmplitude, float motorDuration) =>
            new SendHapticImpulseCommand
            {
                header = new InputDeviceCommand(
                    new FourCC('X', 'H', 'I', '0'), InputDeviceCommand.BaseCommandSize + 12),
                channel = motorChannel,
                amplitude = motorAmplitude,
                duration = motorDuration,
            };
    }
}

namespace UnityShim
{
    /// <summary>A connected gamepad, and the speeds that its motors were set to.</summary>
    public sealed class HeldGamepad
    {
        private readonly UnityEngine.InputSystem.Gamepad pad;

        private HeldGamepad(string name) => pad = new UnityEngine.InputSystem.Gamepad(name);

        public IReadOnlyList<(double Seconds, float Low, float High)> Speeds => pad.Speeds;

        /// <summary>The pad is the one that was used last.</summary>
        public bool IsCurrent
        {
            get => UnityEngine.InputSystem.Gamepad.current == pad;
            set => UnityEngine.InputSystem.Gamepad.current = value ? pad : null;
        }

        public static HeldGamepad Take(string name) => new HeldGamepad(name) { IsCurrent = true };
    }
}

namespace UnityEngine.InputSystem.Layouts
{
    [AttributeUsage(AttributeTargets.Field | AttributeTargets.Property, AllowMultiple = true)]
    public sealed class InputControlAttribute : PropertyAttribute
    {
        internal const uint Automatic = uint.MaxValue;

        public string? usage { get; set; }

        public string? alias { get; set; }

        public string[]? aliases { get; set; }

        public uint offset { get; set; } = Automatic;

        public bool noisy { get; set; }
    }

    [AttributeUsage(AttributeTargets.Class, Inherited = false)]
    public sealed class InputControlLayoutAttribute : Attribute
    {
        public string? displayName { get; set; }

        public string[]? commonUsages { get; set; }
    }

    public struct InputDeviceMatcher
    {
        private (string Key, string Pattern, bool IsRegex)[]? patterns;

        public InputDeviceMatcher WithInterface(string pattern, bool supportRegex = true) =>
            With("interface", pattern, supportRegex);

        public InputDeviceMatcher WithProduct(string pattern, bool supportRegex = true) =>
            With("product", pattern, supportRegex);

        internal bool Matches(string interfaceName, string product) => patterns != null && patterns.All(each =>
        {
            string value = each.Key == "product" ? product : interfaceName;
            return each.IsRegex
                ? Regex.IsMatch(value, each.Pattern, RegexOptions.IgnoreCase)
                : string.Equals(value, each.Pattern, StringComparison.OrdinalIgnoreCase);
        });

        private InputDeviceMatcher With(string key, string pattern, bool supportRegex)
        {
            bool isRegex = supportRegex && !pattern.All(each => char.IsLetterOrDigit(each) || char.IsWhiteSpace(each));
            return new InputDeviceMatcher
            {
                patterns = (patterns ?? Array.Empty<(string, string, bool)>()).Append((key, pattern, isRegex)).ToArray(),
            };
        }
    }
}

namespace UnityEngine.InputSystem.XR
{
    public static class XRUtilities
    {
        public const string InterfaceMatchAnyVersion = "^(XRInput)";
    }

    public class XRController : TrackedDevice
    {
        internal static XRController? Left;
        internal static XRController? Right;

        public static XRController? leftHand => Left;

        public static XRController? rightHand => Right;
    }

    public class XRControllerWithRumble : XRController
    {
        internal List<(double Seconds, float Amplitude, float Duration)> Impulses { get; } =
            new List<(double, float, float)>();

        public void SendImpulse(float amplitude, float duration)
        {
            SendHapticImpulseCommand command = SendHapticImpulseCommand.Create(0, amplitude, duration);
            ExecuteCommand(ref command);
        }

        internal static XRControllerWithRumble Take(string name)
        {
            var taken = new XRControllerWithRumble { displayName = name };
            Right = taken;
            return taken;
        }

        internal static XRControllerWithRumble TakeLeft(string name)
        {
            var taken = new XRControllerWithRumble { displayName = name };
            Left = taken;
            return taken;
        }

        internal static void Drop()
        {
            Left = null;
            Right = null;
        }

        private protected override unsafe void Receive(InputDeviceCommand* command)
        {
            if (command->type == SendHapticImpulseCommand.Create(0, 0f, 0f).typeStatic)
            {
                float* data = (float*)command->payloadPtr;
                Impulses.Add((Clock.UnscaledSeconds, data[1], data[2]));
            }
        }
    }
}
