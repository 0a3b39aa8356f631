#nullable enable
namespace HaptoFlow.Studies
{
    /// <summary>Counts the seconds of a session with a clock that may stop, jump or go backwards, for example when a
    /// headset is put down or a computer sleeps.</summary>
    internal sealed class SessionClock
    {
        /// <summary>Longest frame while a person takes part.</summary>
        public const double MaximumFrameSeconds = 1.0;

        private double lastSeconds = double.NaN;

        public SessionClock(double elapsedSeconds) => ElapsedSeconds = elapsedSeconds;

        public double ElapsedSeconds { get; private set; }

        /// <param name="counts">False while the session is paused.</param>
        /// <returns>False after a jump, which is not counted.</returns>
        public bool Advance(double nowSeconds, bool counts)
        {
            double passed = nowSeconds - lastSeconds;
            bool isFirst = double.IsNaN(lastSeconds);
            lastSeconds = nowSeconds;
            bool isSteady = passed >= 0.0 && passed <= MaximumFrameSeconds;
            if (counts && isSteady)
            {
                ElapsedSeconds += passed;
            }
            return isSteady || isFirst;
        }
    }
}
