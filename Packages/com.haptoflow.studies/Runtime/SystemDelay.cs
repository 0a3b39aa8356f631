#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;

namespace HaptoFlow.Studies
{
    /// <summary>The delay from the pen's motion to the hand without any delay that a study adds: the sum of four parts,
    /// in ms. The formula is the paper's: each part counts in full, as if every event just missed the previous one. Any
    /// thread.</summary>
    public readonly struct SystemDelay
    {
        /// <summary>Upper limit of the delay that an output can add, in ms.</summary>
        public const double MaximumArtificialMilliseconds = OutputProcessing.MaximumDelayMilliseconds;

        /// <param name="poseIntervalMilliseconds">Interval between two poses of the pen: a frame.</param>
        /// <param name="inferenceMilliseconds">Time of an inference; 0 for a signal, which needs none.</param>
        /// <param name="blockMilliseconds">Duration of an audio block.</param>
        /// <param name="deviceMilliseconds">Delay from the audio callback to the hand.</param>
        /// <exception cref="StudyException">A part is not a valid time; the message names it.</exception>
        public SystemDelay(
            double poseIntervalMilliseconds, double inferenceMilliseconds, double blockMilliseconds,
            double deviceMilliseconds)
        {
            PoseIntervalMilliseconds = Checked("pose_interval_ms", poseIntervalMilliseconds);
            InferenceMilliseconds = Checked("inference_ms", inferenceMilliseconds);
            BlockMilliseconds = Checked("block_ms", blockMilliseconds);
            DeviceMilliseconds = Checked("device_ms", deviceMilliseconds);
        }

        /// <summary>Interval between two poses of the pen.</summary>
        public double PoseIntervalMilliseconds { get; }

        /// <summary>Time of an inference; 0 for a signal.</summary>
        public double InferenceMilliseconds { get; }

        /// <summary>Duration of an audio block.</summary>
        public double BlockMilliseconds { get; }

        /// <summary>Delay from the audio callback to the hand.</summary>
        public double DeviceMilliseconds { get; }

        /// <summary>Sum of the parts.</summary>
        public double TotalMilliseconds =>
            PoseIntervalMilliseconds + InferenceMilliseconds + BlockMilliseconds + DeviceMilliseconds;

        /// <summary>True where adding a delay gives the planned one.</summary>
        public bool Reaches(double plannedMilliseconds)
        {
            double missing = plannedMilliseconds - TotalMilliseconds;
            return missing >= 0.0 && missing <= MaximumArtificialMilliseconds;
        }

        /// <summary>The delay that an output has to add for a planned total.</summary>
        /// <exception cref="StudyException">The total cannot be reached; the message names the level.</exception>
        public double ArtificialMilliseconds(double plannedMilliseconds)
        {
            CheckReaches(new[] { plannedMilliseconds });
            return plannedMilliseconds - TotalMilliseconds;
        }

        /// <summary>Throws where levels cannot be reached.</summary>
        /// <exception cref="StudyException">A level cannot be reached; the message names each, and the parts of the
        /// system delay.</exception>
        public void CheckReaches(IEnumerable<double> levelsMilliseconds)
        {
            SystemDelay self = this;
            double[] missed = levelsMilliseconds.Where(level => !self.Reaches(level)).ToArray();
            if (missed.Length == 0)
            {
                return;
            }
            string names = string.Join(
                ", ", missed.Select(level => level.ToString("0.###", CultureInfo.InvariantCulture)));
            string range = FormattableString.Invariant(
                $"{TotalMilliseconds:0.0} to {TotalMilliseconds + MaximumArtificialMilliseconds:0.0} ms");
            throw new StudyException(
                $"the delay level {names} ms cannot be reached: the system delay is {this}, so levels from {range} " +
                "can be; leave the level out of levels_ms, or make the system faster (a shorter audio block, a " +
                "higher frame rate)");
        }

        /// <summary>The sum and its parts, for people.</summary>
        public override string ToString() => string.Format(CultureInfo.InvariantCulture,
            "{0:0.0} ms (pose interval {1:0.0} + inference {2:0.0} + block {3:0.0} + device {4:0.0})",
            TotalMilliseconds, PoseIntervalMilliseconds, InferenceMilliseconds, BlockMilliseconds, DeviceMilliseconds);

        private static double Checked(string key, double milliseconds) => milliseconds >= 0.0 && milliseconds < 10000.0
            ? milliseconds
            : throw new StudyException(FormattableString.Invariant(
                $"{key}: {milliseconds} ms is not a valid part of a delay; expected 0 or more"));
    }

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
