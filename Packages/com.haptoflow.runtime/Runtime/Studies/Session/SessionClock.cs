#nullable enable
namespace HaptoFlow.Studies
{
    /// <summary>Counts a session's seconds from a clock that may stop, jump or go backwards: a headset that was put
    /// down, a computer that slept.</summary>
    internal sealed class SessionClock
    {
        /// <summary>No frame takes longer while somebody takes part.</summary>
        public const double MaximumFrameSeconds = 1.0;

        private double lastSeconds = double.NaN;

        public SessionClock(double elapsedSeconds) => ElapsedSeconds = elapsedSeconds;

        public double ElapsedSeconds { get; private set; }

        /// <param name="counts">False while the session is paused.</param>
        /// <returns>False for a jump; it is left out.</returns>
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
