#nullable enable
using System;
using System.Threading.Tasks;

namespace HaptoFlow
{
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
