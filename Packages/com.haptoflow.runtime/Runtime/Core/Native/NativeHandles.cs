#nullable enable
using System;
using System.Runtime.InteropServices;

namespace HaptoFlow.Native
{
    /// <summary>A handle of the library, closed once, also when its owner is forgotten or the application domain
    /// unloads.</summary>
    internal abstract class NativeHandle : SafeHandle
    {
        protected NativeHandle(IntPtr opened)
            : base(IntPtr.Zero, true) => SetHandle(opened);

        public override bool IsInvalid => handle == IntPtr.Zero;

        /// <summary>For one call; zero once closed, which the library refuses with a message.</summary>
        public IntPtr Value => IsClosed ? IntPtr.Zero : handle;
    }

    internal sealed unsafe class RuntimeHandle : NativeHandle
    {
        public RuntimeHandle(IntPtr opened)
            : base(opened)
        {
        }

        protected override bool ReleaseHandle()
        {
            IntPtr closing = handle;
            return NativeMethods.RuntimeClose(&closing) == (int)HaptoFlowStatus.Ok;
        }
    }

    internal sealed unsafe class ModelHandle : NativeHandle
    {
        public ModelHandle(IntPtr opened)
            : base(opened)
        {
        }

        protected override bool ReleaseHandle()
        {
            IntPtr closing = handle;
            return NativeMethods.ModelClose(&closing) == (int)HaptoFlowStatus.Ok;
        }
    }

    internal sealed unsafe class GeneratorHandle : NativeHandle
    {
        public GeneratorHandle(IntPtr opened)
            : base(opened)
        {
        }

        protected override bool ReleaseHandle()
        {
            IntPtr closing = handle;
            return NativeMethods.GeneratorClose(&closing) == (int)HaptoFlowStatus.Ok;
        }
    }

    internal sealed unsafe class EngineHandle : NativeHandle
    {
        public EngineHandle(IntPtr opened)
            : base(opened)
        {
        }

        protected override bool ReleaseHandle()
        {
            IntPtr closing = handle;
            return NativeMethods.EngineClose(&closing) == (int)HaptoFlowStatus.Ok;
        }
    }
}
