#nullable enable
using System;

namespace HaptoFlow.Studies
{
    /// <summary>Measures how long a frame takes: the time between two poses of the pen. The median of the last frames
    /// counts, so that one that was late does not. Main thread; no garbage.</summary>
    public sealed class PoseInterval
    {
        private const int Frames = 128;

        private readonly double[] ring = new double[Frames];
        private readonly double[] sorted = new double[Frames];
        private int count;
        private int next;

        /// <summary>Frames that count by now, at most 128.</summary>
        public int Count => count;

        /// <summary>Half of the last frames took less, in ms; 0 before the first.</summary>
        public double MedianMilliseconds
        {
            get
            {
                if (count == 0)
                {
                    return 0.0;
                }
                Array.Copy(ring, sorted, count);
                Array.Sort(sorted, 0, count);
                return 1000.0 * sorted[count / 2];
            }
        }

        /// <summary>One more frame; what is no time is left out.</summary>
        /// <param name="seconds">Time.unscaledDeltaTime.</param>
        public void Add(double seconds)
        {
            if (seconds > 0.0 && seconds < SessionClock.MaximumFrameSeconds)
            {
                ring[next] = seconds;
                next = (next + 1) % Frames;
                count = Math.Min(Frames, count + 1);
            }
        }
    }
}
