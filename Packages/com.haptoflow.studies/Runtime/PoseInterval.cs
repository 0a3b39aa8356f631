#nullable enable
using System;

namespace HaptoFlow.Studies
{
    /// <summary>Measures the interval between two poses of the pen: the median of the last frames, so that a late frame
    /// does not count. Main thread; no garbage.</summary>
    public sealed class PoseInterval
    {
        private const int Frames = 128;

        // The median of fewer frames is too uncertain for a delay budget.
        private const int MinimumFrames = 64;

        private readonly double[] ring = new double[Frames];
        private readonly double[] sorted = new double[Frames];
        private int next;

        /// <summary>The number of frames in the median, at most 128.</summary>
        public int Count { get; private set; }

        /// <summary>Whether there have been enough frames for a reliable median.</summary>
        public bool IsMeasured => Count >= MinimumFrames;

        /// <summary>Median of the last frames, in ms; 0 before the first.</summary>
        public double MedianMilliseconds
        {
            get
            {
                if (Count == 0)
                {
                    return 0.0;
                }
                Array.Copy(ring, sorted, Count);
                Array.Sort(sorted, 0, Count);
                return 1000.0 * sorted[Count / 2];
            }
        }

        /// <summary>Adds a frame; an invalid duration is ignored.</summary>
        /// <param name="seconds">Duration of the frame: Time.unscaledDeltaTime.</param>
        public void Add(double seconds)
        {
            if (seconds > 0.0 && seconds < SessionClock.MaximumFrameSeconds)
            {
                ring[next] = seconds;
                next = (next + 1) % Frames;
                Count = Math.Min(Frames, Count + 1);
            }
        }
    }
}
