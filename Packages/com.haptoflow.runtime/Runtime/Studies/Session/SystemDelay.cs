#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;

namespace HaptoFlow.Studies
{
    /// <summary>How late the hand feels what the pen does, without any delay that a study adds: the sum of four parts,
    /// in ms. The formula is the paper's: each part counts in full, as if every event just missed the part before.
    /// Any thread.</summary>
    public readonly struct SystemDelay
    {
        /// <summary>The longest delay that an output can add, in ms.</summary>
        public const double MaximumArtificialMilliseconds = OutputProcessing.MaximumDelayMilliseconds;

        /// <param name="poseIntervalMilliseconds">Between two poses of the pen: the time of a frame.</param>
        /// <param name="inferenceMilliseconds">Of the network; 0 for a signal that needs none.</param>
        /// <param name="blockMilliseconds">Of an audio block.</param>
        /// <param name="deviceMilliseconds">From the audio callback to the hand.</param>
        /// <exception cref="StudyException">A part is no time; the message names it.</exception>
        public SystemDelay(
            double poseIntervalMilliseconds, double inferenceMilliseconds, double blockMilliseconds,
            double deviceMilliseconds)
        {
            PoseIntervalMilliseconds = Checked("pose_interval_ms", poseIntervalMilliseconds);
            InferenceMilliseconds = Checked("inference_ms", inferenceMilliseconds);
            BlockMilliseconds = Checked("block_ms", blockMilliseconds);
            DeviceMilliseconds = Checked("device_ms", deviceMilliseconds);
        }

        /// <summary>Between two poses of the pen.</summary>
        public double PoseIntervalMilliseconds { get; }

        /// <summary>Of the network; 0 for a signal.</summary>
        public double InferenceMilliseconds { get; }

        /// <summary>Of an audio block.</summary>
        public double BlockMilliseconds { get; }

        /// <summary>From the audio callback to the hand.</summary>
        public double DeviceMilliseconds { get; }

        /// <summary>The parts together.</summary>
        public double TotalMilliseconds =>
            PoseIntervalMilliseconds + InferenceMilliseconds + BlockMilliseconds + DeviceMilliseconds;

        /// <summary>The delay can be had by adding some.</summary>
        public bool Reaches(double plannedMilliseconds)
        {
            double missing = plannedMilliseconds - TotalMilliseconds;
            return missing >= 0.0 && missing <= MaximumArtificialMilliseconds;
        }

        /// <summary>What an output has to add for a delay in all.</summary>
        /// <exception cref="StudyException">That cannot be reached; the message names the level.</exception>
        public double ArtificialMilliseconds(double plannedMilliseconds)
        {
            CheckReaches(new[] { plannedMilliseconds });
            return plannedMilliseconds - TotalMilliseconds;
        }

        /// <summary>Refuses levels that cannot be reached.</summary>
        /// <exception cref="StudyException">There are such levels; the message names each, and the parts of the system
        /// delay.</exception>
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
                $"{key}: {milliseconds} ms is no part of a delay; expected 0 or more"));
    }
}
