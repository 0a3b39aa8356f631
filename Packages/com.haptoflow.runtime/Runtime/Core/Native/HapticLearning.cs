#nullable enable
using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using System.Threading.Tasks;
using HaptoFlow.Model;
using HaptoFlow.Native;
using HaptoFlow.Recordings;

namespace HaptoFlow
{
    /// <summary>Name and settings of a material to learn.</summary>
    public sealed class LearningOptions
    {
        /// <summary>Name of the material, like a label's: lower case, 1 to 128 bytes; empty for the
        /// recording's.</summary>
        public string Name { get; set; } = "";

        /// <summary>For example "cloth"; may be empty.</summary>
        public string Category { get; set; } = "";

        /// <summary>One or two sentences; may be empty.</summary>
        public string Description { get; set; } = "";

        /// <summary>Licence of the recording; empty for what its files say.</summary>
        public string Licence { get; set; } = "";

        /// <summary>Seed of all noise.</summary>
        public ulong Seed { get; set; } = 1;

        /// <summary>Time limit of the fit on one core, in seconds; 0 for 20.</summary>
        public double SecondsLimit { get; set; }
    }

    /// <summary>Learns a material from a recording on a thread of its own. Any thread except an audio callback; only
    /// members that say so block.</summary>
    public sealed class HapticLearning : IDisposable
    {
        private static readonly List<HapticLearning> Running = new List<HapticLearning>();

        private readonly LearningProgress progress = new LearningProgress();
        private readonly HapticCancellation cancellation;
        private readonly Task<(string Material, string Report)> work;
        private Task ended = Task.CompletedTask;
        private bool isDisposed;

        private HapticLearning(byte[] modelFile, Recording recording, LearningOptions options)
        {
            cancellation = new HapticCancellation();
            work = Task.Run(() => Learn(modelFile, recording, options));
        }

        /// <summary>Progress, 0 to 1.</summary>
        public float Share => progress.Share;

        /// <summary>The present step, for people; empty at the start.</summary>
        public string Doing => progress.Doing;

        /// <summary>True after success, failure or cancellation.</summary>
        public bool IsCompleted => work.IsCompleted;

        /// <summary>The text of the material file; null until it is complete, and where there is none.</summary>
        public string? Material => work.Status == TaskStatus.RanToCompletion ? work.Result.Material : null;

        /// <summary>The label of the model nearest to the material, to use where the material cannot be; empty without
        /// a material.</summary>
        public string NearestLabel => Report is { } report ? JsonValue.Parse(report.Trim())["nearest_label"].AsText() : "";

        /// <summary>Results of the fit as a JSON object; null without a material.</summary>
        public string? Report => work.Status == TaskStatus.RanToCompletion ? work.Result.Report : null;

        /// <summary>Why learning failed; null on success, during learning, and after a cancellation.</summary>
        public string? Problem => work.IsFaulted && !IsCancelled ? work.Exception!.GetBaseException().Message : null;

        /// <summary>True after a cancellation.</summary>
        public bool IsCancelled => work.IsFaulted &&
            work.Exception!.GetBaseException() is HaptoFlowException { Status: HaptoFlowStatus.Cancelled };

        /// <summary>Starts learning and returns at once.</summary>
        /// <param name="modelFile">The .haptoflow file that the material is for. Do not modify the array during
        /// learning.</param>
        /// <param name="recording">A recording of known speed and force with at least 10 s of sliding. Otherwise <see
        /// cref="Problem"/> tells what is missing.</param>
        /// <exception cref="HaptoFlowException">The native library is missing.</exception>
        public static HapticLearning Start(byte[] modelFile, Recording recording, LearningOptions options)
        {
            lock (Running)
            {
                var learning = new HapticLearning(modelFile, recording, options);
                Running.Add(learning);
                // After adding to the list: learning may have ended already.
                learning.ended = learning.work.ContinueWith(_ => learning.Ended());
                return learning;
            }
        }

        /// <summary>Ends learning within a fraction of a second. Does not block.</summary>
        public void Cancel()
        {
            lock (Running)
            {
                if (!isDisposed)
                {
                    cancellation.Cancel();
                }
            }
        }

        /// <summary>Blocks until learning has ended.</summary>
        public void Wait() => ((IAsyncResult)ended).AsyncWaitHandle.WaitOne();

        /// <summary>Cancels learning if it is under way. Does not block.</summary>
        public void Dispose() => Cancel();

        /// <summary>Cancels all learning and blocks until it has ended: native code must not call back into a process
        /// or an application domain that has ended.</summary>
        public static void EndAll()
        {
            HapticLearning[] all;
            lock (Running)
            {
                all = Running.ToArray();
            }
            foreach (HapticLearning each in all)
            {
                each.Cancel();
            }
            foreach (HapticLearning each in all)
            {
                each.Wait();
            }
        }

        private void Ended()
        {
            lock (Running)
            {
                Running.Remove(this);
                isDisposed = true;
                cancellation.Dispose();
            }
        }

        private (string Material, string Report) Learn(byte[] modelFile, Recording recording, LearningOptions options)
        {
            using OnnxRuntime runtime = OnnxRuntime.Open();
            using HapticModel model = HapticModel.Open(modelFile);
            GCHandle context = GCHandle.Alloc(progress);
            try
            {
                return Learn(runtime, model, recording, options, GCHandle.ToIntPtr(context));
            }
            finally
            {
                context.Free();
            }
        }

        private unsafe (string Material, string Report) Learn(
            OnnxRuntime runtime, HapticModel model, Recording recording, LearningOptions options, IntPtr context)
        {
            IntPtr opened;
            fixed (byte* name = NativeCall.Utf8(options.Name), category = NativeCall.Utf8(options.Category))
            fixed (byte* description = NativeCall.Utf8(options.Description))
            fixed (byte* licence = NativeCall.Utf8(options.Licence))
            {
                var native = new NativeLearningOptions
                {
                    StructSize = (uint)sizeof(NativeLearningOptions),
                    Runtime = runtime.Handle.Value,
                    Model = model.Handle.Value,
                    Name = (IntPtr)name,
                    Category = (IntPtr)category,
                    Description = (IntPtr)description,
                    Licence = (IntPtr)licence,
                    Seed = options.Seed,
                    SecondsLimit = options.SecondsLimit,
                    Progress = LearningProgress.Function,
                    ProgressContext = context,
                    Cancellation = cancellation.Handle.Value,
                };
                recording.Give(ref native);
                NativeCall.Check(NativeMethods.LearnMaterial(&native, &opened));
            }
            GC.KeepAlive(runtime);
            GC.KeepAlive(model);
            GC.KeepAlive(recording);
            GC.KeepAlive(cancellation);
            using var learning = new NativeHandle(opened, NativeMethods.LearningClose);
            IntPtr material;
            IntPtr report;
            learning.Check(NativeMethods.LearningResults(learning.Value, &material, &report));
            return (NativeCall.Text(material), NativeCall.Text(report));
        }
    }

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

        public float Share => share;

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
