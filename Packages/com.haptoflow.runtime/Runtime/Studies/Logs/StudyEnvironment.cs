#nullable enable
namespace HaptoFlow.Studies
{
    /// <summary>Where the delay between the audio callback and the hand is known from.</summary>
    public enum DeviceDelaySource
    {
        /// <summary>Assumed; logs and reports say so.</summary>
        Estimated,

        /// <summary>Measured with an oscilloscope or an accelerometer on this set-up.</summary>
        Measured,
    }

    /// <summary>What plays a study: the application, the headset, the audio device. For the record; nothing here names
    /// a person.</summary>
    public sealed class StudyEnvironment
    {
        /// <summary>Name and version.</summary>
        public string Application { get; set; } = "";

        /// <summary>Unity's version.</summary>
        public string Unity { get; set; } = "";

        /// <summary>HaptoFlow's version.</summary>
        public string Package { get; set; } = "";

        /// <summary>The platform, for example WindowsPlayer.</summary>
        public string Platform { get; set; } = "";

        /// <summary>The headset; empty without one.</summary>
        public string Headset { get; set; } = "";

        /// <summary>Frames a second of headset or screen; 0 where neither says.</summary>
        public double RefreshRateHz { get; set; }

        /// <summary>Of the audio device, in Hz.</summary>
        public int OutputRateHz { get; set; }

        /// <summary>Frames of an audio block.</summary>
        public int BlockFrames { get; set; }

        /// <summary>Where the device delay is known from.</summary>
        public DeviceDelaySource DeviceDelaySource { get; set; }

        /// <summary>How it was measured, or what the estimate rests on.</summary>
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
