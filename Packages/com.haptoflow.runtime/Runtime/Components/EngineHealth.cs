#nullable enable

namespace HaptoFlow
{
    /// <summary>Looks once a second whether an engine still generates. Main thread; no garbage while it does.</summary>
    internal sealed class EngineHealth
    {
        private const double PeriodSeconds = 1.0;

        private double nextSeconds = double.NegativeInfinity;
        private bool told;

        /// <summary>What to tell of a worker that has ended, once; null otherwise.</summary>
        public string? Examine(double nowSeconds, HapticEngine engine)
        {
            if (told || nowSeconds < nextSeconds)
            {
                return null;
            }
            nextSeconds = nowSeconds + PeriodSeconds;
            EngineStatistics statistics = engine.Statistics();
            return Judge(statistics, statistics.WorkerIsAlive ? "" : engine.LastFailure());
        }

        /// <summary>What there is to tell of such statistics, once; null for nothing.</summary>
        internal string? Judge(in EngineStatistics statistics, string lastFailure)
        {
            if (told || statistics.WorkerIsAlive)
            {
                return null;
            }
            told = true;
            string cause = lastFailure.Length > 0 ? $" ({lastFailure})" : "";
            return $"the thread that generates has ended{cause}; Haptics.Restart starts it anew";
        }
    }
}
