#nullable enable
namespace HaptoFlow
{
    /// <summary>An output as the interface between a stylus's voice and the device. Main thread.</summary>
    internal interface IVoiceTarget
    {
        /// <summary>Rate at which the output renders, 8000 to 192000 Hz.</summary>
        int SampleRateHz { get; }

        /// <summary>Gain, 0 to 1.</summary>
        float Strength { get; }

        /// <summary>True while the output plays a signal instead of textures: it begins and ends with the tip's
        /// motion.</summary>
        bool PlaysSignal { get; }

        /// <summary>Renders the voice until it is closed and has faded. A voice has one output.</summary>
        void Add(HapticVoice voice);
    }
}
