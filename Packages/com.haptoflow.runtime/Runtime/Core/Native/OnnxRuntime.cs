#nullable enable
using System;
using HaptoFlow.Native;

namespace HaptoFlow
{
    /// <summary>ONNX Runtime for the native library. One per process is enough.</summary>
    public sealed unsafe class OnnxRuntime : IDisposable
    {
        private OnnxRuntime(IntPtr opened) => Handle = new NativeHandle(opened, NativeMethods.RuntimeClose);

        internal NativeHandle Handle { get; }

        /// <summary>Opens the ONNX Runtime of this platform's package (onnxruntime). Any thread that may block for the
        /// disk.</summary>
        /// <exception cref="HaptoFlowException">A library is missing or belongs to another version of the
        /// package, or ONNX Runtime is older than version 1.16.</exception>
        public static OnnxRuntime Open() => NativeCall.OrMissing(() =>
        {
            LibraryAgreement.Require();
            var options = new RuntimeOptions
            {
                StructSize = (uint)sizeof(RuntimeOptions),
                OrtApiBase = NativeMethods.OrtGetApiBase(),
            };
            IntPtr opened;
            NativeCall.Check(NativeMethods.RuntimeOpen(&options, &opened));
            return new OnnxRuntime(opened);
        });

        /// <summary>Version of the native library, for example "0.2.0". Any thread.</summary>
        /// <exception cref="HaptoFlowException">The library is missing.</exception>
        public static string LibraryVersion() => NativeCall.OrMissing(() => NativeCall.Text(NativeMethods.Version()));

        /// <summary>Frees the handle; engines and generators created with it stay usable.</summary>
        public void Dispose() => Handle.Dispose();
    }

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
