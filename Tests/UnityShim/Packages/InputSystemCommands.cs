using System;
using System.Runtime.InteropServices;
using UnityEngine.InputSystem.LowLevel;
using UnityEngine.InputSystem.Utilities;

namespace UnityEngine.InputSystem
{
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
