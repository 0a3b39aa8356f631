#nullable enable
using System;
using System.Threading.Tasks;

namespace HaptoFlow
{
    /// <summary>A change of quality under way on another thread: the engine may have to load a tier first. Main thread.
    /// </summary>
    internal sealed class QualityChange
    {
        private readonly Task<string?> task;
        private bool taken;

        /// <param name="before">Ends first: the newest change must win.</param>
        public QualityChange(HapticEngine engine, HapticQuality quality, QualityChange? before)
        {
            Task<string?> earlier = before?.task ?? Task.FromResult<string?>(null);
            task = earlier.ContinueWith(_ => Change(engine, quality), TaskScheduler.Default);
        }

        /// <summary>Waits for its end.</summary>
        public void Finish() => ((IAsyncResult)task).AsyncWaitHandle.WaitOne();

        /// <summary>Why the quality could not be changed, told once; null while it is under way or where it was.
        /// </summary>
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
