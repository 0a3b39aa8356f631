#nullable enable
namespace HaptoFlow
{
    /// <summary>An output, as a stylus's voice sees it. Main thread.</summary>
    internal interface IVoiceTarget
    {
        /// <summary>At which the output renders, 8000 to 192000 Hz.</summary>
        int SampleRateHz { get; }

        /// <summary>Gain, 0 to 1.</summary>
        float Strength { get; }

        /// <summary>The output plays a signal in the place of what is felt: it begins and ends with the tip's motion.
        /// </summary>
        bool PlaysSignal { get; }

        /// <summary>From now on the output renders the voice, and nobody else does.</summary>
        void Add(HapticVoice voice);

        /// <summary>The output renders the voice no more.</summary>
        void Remove(HapticVoice voice);
    }
}
