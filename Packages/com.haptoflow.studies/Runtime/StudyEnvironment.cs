#nullable enable
namespace HaptoFlow.Studies
{
    /// <summary>Origin of the value for the delay between the audio callback and the hand.</summary>
    public enum DeviceDelaySource
    {
        /// <summary>Assumed; logs and reports state it.</summary>
        Estimated,

        /// <summary>Measured with an oscilloscope or an accelerometer on this set-up.</summary>
        Measured,
    }

    /// <summary>Application, headset and audio device of a study, for the record. Contains nothing about a
    /// person.</summary>
    public sealed class StudyEnvironment
    {
        /// <summary>Name and version of the application.</summary>
        public string Application { get; set; } = "";

        /// <summary>Unity's version.</summary>
        public string Unity { get; set; } = "";

        /// <summary>HaptoFlow's version.</summary>
        public string Package { get; set; } = "";

        /// <summary>The platform, for example WindowsPlayer.</summary>
        public string Platform { get; set; } = "";

        /// <summary>Name of the headset; empty without one.</summary>
        public string Headset { get; set; } = "";

        /// <summary>Refresh rate of headset or screen in Hz; 0 where unknown.</summary>
        public double RefreshRateHz { get; set; }

        /// <summary>Sample rate of the audio device, in Hz.</summary>
        public int OutputRateHz { get; set; }

        /// <summary>Frames of an audio block.</summary>
        public int BlockFrames { get; set; }

        /// <summary>Origin of the device delay.</summary>
        public DeviceDelaySource DeviceDelaySource { get; set; }

        /// <summary>How the delay was measured, or the basis of the estimate.</summary>
        public string DeviceDelayNote { get; set; } = "";

        internal StudyFields Build() => new StudyFields
        {
            { "application", Application }, { "unity", Unity }, { "package", Package }, { "platform", Platform },
        };

        internal StudyFields Device(SystemDelay delay) => new StudyFields
        {
            { "headset", Headset },
            { "refresh_rate_hz", RefreshRateHz },
            { "output_rate_hz", OutputRateHz },
            { "block_frames", BlockFrames },
            { "device_delay_ms", delay.DeviceMilliseconds },
            { "device_delay_source", DeviceDelaySource == DeviceDelaySource.Measured ? "measured" : "estimated" },
            { "device_delay_note", DeviceDelayNote },
        };
    }
}
