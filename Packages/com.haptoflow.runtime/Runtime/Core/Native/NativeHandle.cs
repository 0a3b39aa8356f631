#nullable enable
using System;
using System.Runtime.InteropServices;

namespace HaptoFlow.Native
{
    /// <summary>A handle of the library that is closed exactly once, also without Dispose and when the application
    /// domain unloads.</summary>
    internal sealed unsafe class NativeHandle : SafeHandle
    {
        private readonly Closing close;

        /// <param name="close">The library's function that closes handles of this kind.</param>
        public NativeHandle(IntPtr opened, Closing close)
            : base(IntPtr.Zero, true)
        {
            this.close = close;
            SetHandle(opened);
        }

        public delegate int Closing(IntPtr* closing);

        public override bool IsInvalid => handle == IntPtr.Zero;

        /// <summary>The handle for one call; zero once closed, which the library refuses with a message.</summary>
        public IntPtr Value => IsClosed ? IntPtr.Zero : handle;

        /// <summary>Ends a call that was made with <see cref="Value"/>: the handle stays open until here.</summary>
        /// <exception cref="HaptoFlowException">As for <see cref="NativeCall.Check"/>.</exception>
        public void Check(int status)
        {
            NativeCall.Check(status);
            GC.KeepAlive(this);
        }

        protected override bool ReleaseHandle()
        {
            IntPtr closing = handle;
            return close(&closing) == (int)HaptoFlowStatus.Ok;
        }
    }
}
