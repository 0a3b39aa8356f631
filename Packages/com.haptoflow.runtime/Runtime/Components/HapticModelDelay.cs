#nullable enable

namespace HaptoFlow
{
    /// <summary>The delay between motion and sound that a model causes on this machine, measured with a voice that is
    /// not played.</summary>
    public readonly struct HapticModelDelay
    {
        internal HapticModelDelay(double leadMilliseconds, in TierTimes inference)
        {
            LeadMilliseconds = leadMilliseconds;
            InferenceMedianMilliseconds = inference.MedianMs;
            InferencePercentile99Milliseconds = inference.Percentile99Ms;
            Runs = inference.Runs;
        }

        /// <summary>Time from a contact state to the first sample generated from it: inference and the audio blocks
        /// that pass meanwhile. The device's buffer, the amplifier and the actuator add to it.</summary>
        public double LeadMilliseconds { get; }

        /// <summary>Median time of an inference.</summary>
        public double InferenceMedianMilliseconds { get; }

        /// <summary>99th percentile of the time of an inference.</summary>
        public double InferencePercentile99Milliseconds { get; }

        /// <summary>Number of inferences measured.</summary>
        public ulong Runs { get; }
    }
}
