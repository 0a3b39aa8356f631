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
    /// <summary>What a material that is learnt is called, and how it is learnt.</summary>
    public sealed class LearningOptions
    {
        /// <summary>Of the material, as a label's: lower case, 1 to 128 bytes.</summary>
        public string Name { get; set; } = "";

        /// <summary>For example "cloth"; may be empty.</summary>
        public string Category { get; set; } = "";

        /// <summary>One or two sentences; may be empty.</summary>
        public string Description { get; set; } = "";

        /// <summary>Of the recording; empty where nobody knows.</summary>
        public string Licence { get; set; } = "";

        /// <summary>The tier of the model that the material is fitted to, by name; null for the default tier.</summary>
        public string? Tier { get; set; }

        /// <summary>Key of all noise.</summary>
        public ulong Seed { get; set; } = 1;

        /// <summary>Of a ruled surface: k1x, k1y, k2x, k2y in cycles a millimetre, zeros for a surface without ribs;
        /// null to find them in the recording.</summary>
        public float[]? WaveVectorsPerMillimetre { get; set; }

        /// <summary>Longest time that the fit may take on one core, in seconds; 0 for 20.</summary>
        public double SecondsLimit { get; set; }
    }

    /// <summary>A material being learnt from a recording by a thread of its own. Methods may be called from any thread
    /// that is not an audio callback; only those that say so wait.</summary>
    public sealed class HapticLearning : IDisposable
    {
        private static readonly List<HapticLearning> Running = new List<HapticLearning>();

        private readonly LearningProgress progress = new LearningProgress();
        private readonly HapticCancellation cancellation;
        private readonly Task<Learnt> work;
        private Task ended = Task.CompletedTask;
        private bool isDisposed;

        private HapticLearning(byte[] modelFile, Recording recording, LearningOptions options)
        {
            cancellation = new HapticCancellation();
            work = Task.Run(() => Learn(modelFile, recording, options));
        }

        /// <summary>0 to 1.</summary>
        public float Share => progress.Share;

        /// <summary>What is being done, for people; empty at the beginning.</summary>
        public string Doing => progress.Doing;

        /// <summary>It ended: with a material, with a failure, or cancelled.</summary>
        public bool IsCompleted => work.IsCompleted;

        /// <summary>The text of the material file; null before the end, and where there is none.</summary>
        public string? Material => work.Status == TaskStatus.RanToCompletion ? work.Result.Material : null;

        /// <summary>The label of the model that is nearest to the material, to be felt where the material cannot be;
        /// empty where there is no material.</summary>
        public string NearestLabel => work.Status == TaskStatus.RanToCompletion ? work.Result.NearestLabel : "";

        /// <summary>What the fit achieved, as a JSON object; null where there is no material.</summary>
        public string? Report => work.Status == TaskStatus.RanToCompletion ? work.Result.Report : null;

        /// <summary>Why there is no material; null where there is one, while it is being learnt, and where it was
        /// cancelled.</summary>
        public string? Problem => work.IsFaulted && !IsCancelled ? work.Exception!.GetBaseException().Message : null;

        /// <summary>It ended because somebody wanted it to.</summary>
        public bool IsCancelled => work.IsFaulted &&
            work.Exception!.GetBaseException() is HaptoFlowException { Status: HaptoFlowStatus.Cancelled };

        /// <summary>Begins; returns at once.</summary>
        /// <param name="modelFile">The bytes of the .haptoflow file under which the material shall sound. Not to be
        /// changed meanwhile.</param>
        /// <param name="recording">Of known speed and force; 10 s of sliding or more.</param>
        /// <exception cref="HaptoFlowException">The native library is not there.</exception>
        /// <exception cref="ArgumentException">The material has no name, or the recording's speed or force is not
        /// known.</exception>
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
                    "columns, in its sidecar or by Recording.With", nameof(recording));
            }
            lock (Running)
            {
                var learning = new HapticLearning(modelFile, recording, options);
                Running.Add(learning);
                // Later than the list knows it, for it may have ended already.
                learning.ended = learning.work.ContinueWith(_ => learning.Ended());
                return learning;
            }
        }

        /// <summary>It ends as soon as it can, within a fraction of a second.</summary>
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

        /// <summary>Waits until it ended, with whatever outcome.</summary>
        public void Wait() => ((IAsyncResult)ended).AsyncWaitHandle.WaitOne();

        /// <summary>Cancels it where it is under way. Does not wait.</summary>
        public void Dispose() => Cancel();

        /// <summary>Cancels all learnings and waits until they have ended, because native code must not call back into a
        /// process or an application domain that is gone.</summary>
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

        private Learnt Learn(byte[] modelFile, Recording recording, LearningOptions options)
        {
            using OnnxRuntime runtime = OnnxRuntime.Open();
            using HapticModel model = HapticModel.Open(modelFile);
            GCHandle context = GCHandle.Alloc(progress);
            try
            {
                (string material, string report) = NativeLearning.Run(
                    runtime, model, recording, options, cancellation, GCHandle.ToIntPtr(context));
                string nearest = ModelSpace.Of(modelFile).NearestLabel(MaterialFile.Read(material).Embedding);
                return new Learnt(material, report, nearest);
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

        private sealed class Learnt
        {
            public Learnt(string material, string report, string nearestLabel)
            {
                Material = material;
                Report = report;
                NearestLabel = nearestLabel;
            }

            public string Material { get; }

            public string Report { get; }

            public string NearestLabel { get; }
        }
    }
}
