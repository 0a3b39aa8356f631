#nullable enable

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
}
