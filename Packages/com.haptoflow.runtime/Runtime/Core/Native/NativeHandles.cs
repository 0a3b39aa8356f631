#nullable enable
using System;
using System.Runtime.InteropServices;

namespace HaptoFlow.Native
{
    /// <summary>A handle of the library that is closed exactly once, also without Dispose and when the application
    /// domain unloads.</summary>
    internal abstract unsafe class NativeHandle : SafeHandle
    {
        protected NativeHandle(IntPtr opened)
            : base(IntPtr.Zero, true) => SetHandle(opened);

        public override bool IsInvalid => handle == IntPtr.Zero;

        /// <summary>The handle for one call; zero once closed, which the library refuses with a message.</summary>
        public IntPtr Value => IsClosed ? IntPtr.Zero : handle;

        /// <summary>Calls the library's function that closes handles of this kind.</summary>
        protected abstract int Close(IntPtr* closing);

        protected override bool ReleaseHandle()
        {
            IntPtr closing = handle;
            return Close(&closing) == (int)HaptoFlowStatus.Ok;
        }
    }

    internal sealed unsafe class RuntimeHandle : NativeHandle
    {
        public RuntimeHandle(IntPtr opened)
            : base(opened)
        {
        }

        protected override int Close(IntPtr* closing) => NativeMethods.RuntimeClose(closing);
    }

    internal sealed unsafe class ModelHandle : NativeHandle
    {
        public ModelHandle(IntPtr opened)
            : base(opened)
        {
        }

        protected override int Close(IntPtr* closing) => NativeMethods.ModelClose(closing);
    }

    internal sealed unsafe class GeneratorHandle : NativeHandle
    {
        public GeneratorHandle(IntPtr opened)
            : base(opened)
        {
        }

        protected override int Close(IntPtr* closing) => NativeMethods.GeneratorClose(closing);
    }

    internal sealed unsafe class EngineHandle : NativeHandle
    {
        public EngineHandle(IntPtr opened)
            : base(opened)
        {
        }

        protected override int Close(IntPtr* closing) => NativeMethods.EngineClose(closing);
    }

    internal sealed unsafe class WaveFeaturesHandle : NativeHandle
    {
        public WaveFeaturesHandle(IntPtr opened)
            : base(opened)
        {
        }

        protected override int Close(IntPtr* closing) => NativeMethods.WaveFeaturesClose(closing);
    }

    internal sealed unsafe class DeviceWaveHandle : NativeHandle
    {
        public DeviceWaveHandle(IntPtr opened)
            : base(opened)
        {
        }

        protected override int Close(IntPtr* closing) => NativeMethods.DeviceWaveClose(closing);
    }

    internal sealed unsafe class CancellationHandle : NativeHandle
    {
        public CancellationHandle(IntPtr opened)
            : base(opened)
        {
        }

        protected override int Close(IntPtr* closing) => NativeMethods.CancellationClose(closing);
    }

    internal sealed unsafe class RecordingHandle : NativeHandle
    {
        public RecordingHandle(IntPtr opened)
            : base(opened)
        {
        }

        protected override int Close(IntPtr* closing) => NativeMethods.RecordingClose(closing);
    }

    internal sealed unsafe class LearningHandle : NativeHandle
    {
        public LearningHandle(IntPtr opened)
            : base(opened)
        {
        }

        protected override int Close(IntPtr* closing) => NativeMethods.LearningClose(closing);
    }
}
