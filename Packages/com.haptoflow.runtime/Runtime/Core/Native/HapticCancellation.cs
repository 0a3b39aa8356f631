#nullable enable
using System;
using HaptoFlow.Native;

namespace HaptoFlow
{
    /// <summary>Ends loads that are under way: those whose options name it, also later ones. Any thread but an audio
    /// callback's.</summary>
    public sealed unsafe class HapticCancellation : IDisposable
    {
        /// <exception cref="HaptoFlowException">The library is not there, or memory is used up.</exception>
        public HapticCancellation()
        {
            try
            {
                IntPtr opened;
                NativeCall.Check(NativeMethods.CancellationCreate(&opened));
                Handle = new CancellationHandle(opened);
            }
            catch (Exception error) when (NativeCall.IsMissing(error))
            {
                throw NativeCall.Missing(error);
            }
        }

        internal CancellationHandle Handle { get; }

        /// <summary>For good: the loads end with <see cref="HaptoFlowStatus.Cancelled"/>, those under way as soon as
        /// ONNX Runtime lets them.</summary>
        public void Cancel()
        {
            NativeCall.Check(NativeMethods.CancellationCancel(Handle.Value));
            GC.KeepAlive(this);
        }

        /// <summary>Loads that are under way go on.</summary>
        public void Dispose() => Handle.Dispose();
    }
}
