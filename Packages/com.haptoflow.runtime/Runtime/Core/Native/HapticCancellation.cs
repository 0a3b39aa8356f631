#nullable enable
using System;
using HaptoFlow.Native;

namespace HaptoFlow
{
    /// <summary>Cancels the loads whose options reference it, also those that start later. Any thread except an audio
    /// callback.</summary>
    public sealed unsafe class HapticCancellation : IDisposable
    {
        /// <exception cref="HaptoFlowException">The library is missing, or memory is exhausted.</exception>
        public HapticCancellation() => Handle = NativeCall.OrMissing(() =>
        {
            LibraryAgreement.Require();
            IntPtr opened;
            NativeCall.Check(NativeMethods.CancellationCreate(&opened));
            return new NativeHandle(opened, NativeMethods.CancellationClose);
        });

        internal NativeHandle Handle { get; }

        /// <summary>Cancels permanently: the loads end with <see cref="HaptoFlowStatus.Cancelled"/>, those under way as
        /// soon as ONNX Runtime allows.</summary>
        public void Cancel() => Handle.Check(NativeMethods.CancellationCancel(Handle.Value));

        /// <summary>Frees the handle; loads under way continue.</summary>
        public void Dispose() => Handle.Dispose();
    }
}
