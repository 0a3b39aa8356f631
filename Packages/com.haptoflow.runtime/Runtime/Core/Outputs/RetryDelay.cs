#nullable enable
using System;

namespace HaptoFlow.Outputs
{
    /// <summary>Decides when to repeat a call that failed: after a first delay, then after twice as long each time, up
    /// to a limit. One failure never ends a route, and a lasting one costs next to nothing.</summary>
    public sealed class RetryDelay
    {
        private readonly double firstSeconds;
        private readonly double maximumSeconds;
        private double delaySeconds;
        private double dueSeconds = double.NegativeInfinity;
        private bool hasFailed;

        /// <param name="firstSeconds">Delay after the first failure, in s, above 0.</param>
        /// <param name="maximumSeconds">Limit of the delay, in s.</param>
        public RetryDelay(double firstSeconds, double maximumSeconds) =>
            (this.firstSeconds, this.maximumSeconds) = (firstSeconds, maximumSeconds);

        /// <summary>True where the call may be made: it has not failed since a success, or the delay is over.</summary>
        /// <param name="nowSeconds">Time of a real-time clock, in s.</param>
        public bool IsDue(double nowSeconds) => nowSeconds >= dueSeconds;

        /// <summary>Call it after a failure.</summary>
        /// <param name="nowSeconds">Time of the clock of <see cref="IsDue"/>, in s.</param>
        /// <returns>True for the first failure since the last <see cref="Restart"/>, which should be logged.</returns>
        public bool Fail(double nowSeconds)
        {
            delaySeconds = delaySeconds > 0.0 ? Math.Min(2.0 * delaySeconds, maximumSeconds) : firstSeconds;
            dueSeconds = nowSeconds + delaySeconds;
            bool isFirst = !hasFailed;
            hasFailed = true;
            return isFirst;
        }

        /// <summary>Call it after a success, or when something changed that may have caused the failure.</summary>
        public void Forget()
        {
            delaySeconds = 0.0;
            dueSeconds = double.NegativeInfinity;
        }

        /// <summary>Forgets the failures: the next one counts as the first. Call it for another device.</summary>
        public void Restart()
        {
            Forget();
            hasFailed = false;
        }
    }
}
