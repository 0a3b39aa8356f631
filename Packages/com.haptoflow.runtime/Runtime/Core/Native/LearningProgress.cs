#nullable enable
using System;
using System.Runtime.InteropServices;

namespace HaptoFlow.Native
{
    /// <summary>How far a learning has come, as the library says from the thread that learns.</summary>
    internal sealed class LearningProgress
    {
        /// <summary>haptoflow_progress_callback. Kept by this field: a delegate that only native code knows would be
        /// collected.</summary>
        private static readonly Callback Kept = Take;

        private volatile string doing = "";
        private volatile float share;

        [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
        private delegate void Callback(IntPtr context, double share, IntPtr doing);

        /// <summary>For the options; the context is a <see cref="GCHandle"/> to one of these.</summary>
        public static IntPtr Function => Marshal.GetFunctionPointerForDelegate(Kept);

        /// <summary>0 to 1. Any thread.</summary>
        public float Share => share;

        /// <summary>For people. Any thread.</summary>
        public string Doing => doing;

        [MonoPInvokeCallback(typeof(Callback))]
        private static void Take(IntPtr context, double share, IntPtr doing)
        {
            try
            {
                if (GCHandle.FromIntPtr(context).Target is LearningProgress progress)
                {
                    progress.share = (float)Math.Max(0.0, Math.Min(1.0, share));
                    string words = NativeCall.Text(doing);
                    progress.doing = words == progress.doing ? progress.doing : words;
                }
            }
            catch (Exception)
            {
                // No exception may cross into native code; a word about the progress is worth none.
            }
        }
    }
}
