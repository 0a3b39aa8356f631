#nullable enable

namespace HaptoFlow
{
    /// <summary>By how much a model's sound comes after the motion, measured on this machine with a voice that nobody
    /// hears.</summary>
    public readonly struct HapticModelDelay
    {
        internal HapticModelDelay(double leadMilliseconds, in TierTimes inference)
        {
            LeadMilliseconds = leadMilliseconds;
            InferenceMedianMilliseconds = inference.MedianMs;
            InferencePercentile99Milliseconds = inference.Percentile99Ms;
            Runs = inference.Runs;
        }

        /// <summary>From a contact state to the first sample generated from it: inference, and the blocks of the audio
        /// device that pass meanwhile. The device's own buffer, amplifier and actuator come on top.</summary>
        public double LeadMilliseconds { get; }

        /// <summary>Half of the runs of the network took less.</summary>
        public double InferenceMedianMilliseconds { get; }

        /// <summary>Of a hundred runs 99 took less.</summary>
        public double InferencePercentile99Milliseconds { get; }

        /// <summary>Runs behind the figures.</summary>
        public ulong Runs { get; }
    }
}
