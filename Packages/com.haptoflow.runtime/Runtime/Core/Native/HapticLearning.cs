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
        /// <summary>Name of the material, like a label's: lower case, 1 to 128 bytes.</summary>
        public string Name { get; set; } = "";

        /// <summary>For example "cloth"; may be empty.</summary>
        public string Category { get; set; } = "";

        /// <summary>One or two sentences; may be empty.</summary>
        public string Description { get; set; } = "";

        /// <summary>Licence of the recording; empty where unknown.</summary>
        public string Licence { get; set; } = "";

        /// <summary>Name of the tier that the material is fitted to; null for the model's default tier.</summary>
        public string? Tier { get; set; }

        /// <summary>Seed of all noise.</summary>
        public ulong Seed { get; set; } = 1;

        /// <summary>Wave vectors of a ruled surface: k1x, k1y, k2x, k2y in cycles per millimetre; zeros for a surface
        /// without ribs; null to estimate them from the recording.</summary>
        public float[]? WaveVectorsPerMillimetre { get; set; }

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
        private readonly Task<(string Material, string Report, string NearestLabel)> work;
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
        public string NearestLabel => work.Status == TaskStatus.RanToCompletion ? work.Result.NearestLabel : "";

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
        /// <param name="recording">A recording of known speed and force with at least 10 s of sliding.</param>
        /// <exception cref="HaptoFlowException">The native library is missing.</exception>
        /// <exception cref="ArgumentException">The material has no name, or the recording's speed or force is
        /// unknown.</exception>
        public static HapticLearning Start(byte[] modelFile, Recording recording, LearningOptions options)
        {
            if (options.Name.Trim().Length == 0)
            {
                throw new ArgumentException("the material has no name; expected one", nameof(options));
            }
            if (options.WaveVectorsPerMillimetre is { } vectors && vectors.Length != 4)
            {
                throw new ArgumentException(
                    $"{vectors.Length} numbers of wave vectors; expected 4, or none at all", nameof(options));
            }
            if (!recording.KnowsMotion)
            {
                throw new ArgumentException("the recording's speed or force is not known; expected both, in its " +
                    "columns, in its sidecar or through Recording.With", nameof(recording));
            }
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

        private (string Material, string Report, string NearestLabel) Learn(
            byte[] modelFile, Recording recording, LearningOptions options)
        {
            using OnnxRuntime runtime = OnnxRuntime.Open();
            using HapticModel model = HapticModel.Open(modelFile);
            GCHandle context = GCHandle.Alloc(progress);
            try
            {
                (string material, string report) = NativeLearning.Run(
                    runtime, model, recording, options, cancellation, GCHandle.ToIntPtr(context));
                string nearest = model.NearestLabel(MaterialFile.Read(material).Embedding);
                return (material, report, nearest);
            }
            catch (Exception error) when (NativeCall.IsMissing(error))
            {
                throw NativeCall.Missing(error);
            }
            finally
            {
                context.Free();
            }
        }
    }
}
