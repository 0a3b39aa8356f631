#nullable enable
using System;
using System.Runtime.InteropServices;

namespace HaptoFlow.Native
{
    /// <summary>Progress of learning, reported by the library from the learning thread.</summary>
    internal sealed class LearningProgress
    {
        /// <summary>The haptoflow_progress_callback. This field keeps the delegate alive: the garbage collector does
        /// not see references from native code.</summary>
        private static readonly Callback Kept = Take;

        private volatile string doing = "";
        private volatile float share;

        [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
        private delegate void Callback(IntPtr context, double share, IntPtr doing);

        /// <summary>Function pointer for the options; its context is a <see cref="GCHandle"/> to a
        /// LearningProgress.</summary>
        public static IntPtr Function => Marshal.GetFunctionPointerForDelegate(Kept);

        /// <summary>Progress, 0 to 1. Any thread.</summary>
        public float Share => share;

        /// <summary>The present step, for people. Any thread.</summary>
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
                // An exception must not cross into native code, and a lost progress report does no harm.
            }
        }
    }
}
