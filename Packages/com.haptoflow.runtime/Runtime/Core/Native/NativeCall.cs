#nullable enable
using System;
using System.Runtime.InteropServices;
using System.Text;

namespace HaptoFlow.Native
{
    /// <summary>Helpers of native calls: text in UTF-8, failures as exceptions.</summary>
    internal static class NativeCall
    {
        /// <exception cref="HaptoFlowException">The status is not OK; the message is the library's.</exception>
        public static void Check(int status)
        {
            if (status != (int)HaptoFlowStatus.Ok)
            {
                Fail(status);
            }
        }

        public static string Text(IntPtr utf8) => Marshal.PtrToStringUTF8(utf8) ?? "";

        public static byte[] Utf8(string text)
        {
            var bytes = new byte[Encoding.UTF8.GetByteCount(text) + 1];
            Encoding.UTF8.GetBytes(text, 0, text.Length, bytes, 0);
            return bytes;
        }

        /// <summary>Runs calls of a library that may be missing.</summary>
        /// <exception cref="HaptoFlowException">The library, or a function in it, was not found.</exception>
        public static T OrMissing<T>(Func<T> calls)
        {
            try
            {
                return calls();
            }
            catch (Exception error) when (IsMissing(error))
            {
                throw new HaptoFlowException(
                    HaptoFlowStatus.LibraryUnavailable,
                    "HaptoFlow's native library audioplugin_haptoflow, or ONNX Runtime (onnxruntime) that it runs " +
                    "on, cannot be loaded on this platform: install the packages com.haptoflow.runtime and " +
                    "com.github.asus4.onnxruntime in versions that carry binaries for it (" + error.Message + ")",
                    error);
            }
        }

        /// <summary>True where the loader did not find the library, its architecture or one of its functions.</summary>
        public static bool IsMissing(Exception error) =>
            error is DllNotFoundException || error is EntryPointNotFoundException || error is BadImageFormatException;

        private static void Fail(int status)
        {
            string message = Text(NativeMethods.LastMessage());
            string name = Text(NativeMethods.StatusName(status));
            throw new HaptoFlowException((HaptoFlowStatus)status, message.Length > 0 ? message : name);
        }
    }

    /// <summary>A handle of the library that is closed exactly once, also without Dispose and when the application
    /// domain unloads.</summary>
    internal sealed unsafe class NativeHandle : SafeHandle
    {
        private readonly Closing close;

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

    /// <summary>Keeps Unity's linker from stripping fields that no managed code reads but that are part of a native
    /// layout. The linker matches the attribute by name.</summary>
    [AttributeUsage(AttributeTargets.Class | AttributeTargets.Struct)]
    internal sealed class PreserveAttribute : Attribute
    {
    }

    /// <summary>Makes Unity's ahead-of-time compiler create a native entry point for a static method. It matches the
    /// attribute by name, and this assembly has no reference to UnityEngine's own.</summary>
    [AttributeUsage(AttributeTargets.Method)]
    internal sealed class MonoPInvokeCallbackAttribute : Attribute
    {
        public MonoPInvokeCallbackAttribute(Type type) => Type = type;

        public Type Type { get; }
    }
}
