#nullable enable
using System;
using System.Threading.Tasks;

namespace HaptoFlow
{
    /// <summary>Checks once a second that an engine's worker thread is alive. Main thread; no garbage while it
    /// is.</summary>
    internal sealed class EngineHealth
    {
        private const double PeriodSeconds = 1.0;

        private double nextSeconds = double.NegativeInfinity;
        private bool reported;

        /// <summary>The message for a worker that has ended, returned once; null otherwise.</summary>
        public string? Check(double nowSeconds, HapticEngine engine)
        {
            if (reported || nowSeconds < nextSeconds)
            {
                return null;
            }
            nextSeconds = nowSeconds + PeriodSeconds;
            EngineStatistics statistics = engine.Statistics();
            return MessageFor(statistics, statistics.WorkerIsAlive ? "" : engine.LastFailure());
        }

        /// <summary>The message for statistics of a worker that has ended, returned once; null otherwise.</summary>
        internal string? MessageFor(in EngineStatistics statistics, string lastFailure)
        {
            if (reported || statistics.WorkerIsAlive)
            {
                return null;
            }
            reported = true;
            string cause = lastFailure.Length > 0 ? $" ({lastFailure})" : "";
            return $"the engine's worker thread has ended{cause}; call Haptics.Restart";
        }
    }

    /// <summary>A change of quality on another thread: the engine may have to load a tier first. Main thread.</summary>
    internal sealed class QualityChange
    {
        private readonly Task<string?> task;
        private bool taken;

        /// <param name="before">The previous change, which this one waits for: the last request decides.</param>
        public QualityChange(HapticEngine engine, HapticQuality quality, QualityChange? before)
        {
            Task<string?> earlier = before?.task ?? Task.FromResult<string?>(null);
            task = earlier.ContinueWith(_ => Change(engine, quality), TaskScheduler.Default);
        }

        /// <summary>Waits until the change has succeeded or failed.</summary>
        public void Finish() => ((IAsyncResult)task).AsyncWaitHandle.WaitOne();

        /// <summary>Why the quality was not changed, returned once; null while the change is under way or where it
        /// succeeded.</summary>
        public string? TakeFailure()
        {
            if (taken || !task.IsCompleted)
            {
                return null;
            }
            taken = true;
            return task.Result;
        }

        private static string? Change(HapticEngine engine, HapticQuality quality)
        {
            try
            {
                engine.SetQuality(quality);
                return null;
            }
            catch (HaptoFlowException refusal)
            {
                return refusal.Message;
            }
        }
    }
}
