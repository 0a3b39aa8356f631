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

        /// <summary>Zero-terminated UTF-8.</summary>
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
                throw Missing(error);
            }
        }

        /// <summary>The exception for a library, or a function in it, that was not found.</summary>
        public static HaptoFlowException Missing(Exception cause) => new HaptoFlowException(
            HaptoFlowStatus.LibraryUnavailable,
            "HaptoFlow's native library audioplugin_haptoflow, or ONNX Runtime (onnxruntime) that it runs on, cannot " +
            "be loaded on this platform: install the packages com.haptoflow.runtime and " +
            "com.github.asus4.onnxruntime in versions that carry binaries for it (" + cause.Message + ")", cause);

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
}
