#nullable enable
using System.IO;
using UnityEngine;

namespace HaptoFlow.Studies
{
    /// <summary>Base class of a study's settings: the choices that every study with an actuator, headphones and a log
    /// has to make. One asset serves all participants of a study.</summary>
    public abstract class StudySettings : ScriptableObject
    {
        [SerializeField, Tooltip("The order of the trials follows from the seed and the participant's number. Use " +
            "the same seed for all participants of a study.")]
        private ulong seed = 1;

        [SerializeField, Tooltip("The logs are written to this folder. When it is empty, they are written to the " +
            "folder Studies in the player's persistent data.")]
        private string folder = "";

        [SerializeField, Tooltip("The log names the headset, and how it is connected, with these words.")]
        private string headset = "";

        [SerializeField, Min(0), Tooltip("The actuator is wired to this channel of the audio device, counted from 0. " +
            "Every other channel plays the masking noise.")]
        private int hapticChannel = 1;

        [SerializeField, Tooltip("The headphones play noise of this colour.")]
        private NoiseColour noiseColour = NoiseColour.White;

        [SerializeField, Range(MaskingNoise.MinimumDecibels, MaskingNoise.MaximumDecibels)]
        [Tooltip("The noise has this root mean square, in dB of full scale. Participants must not hear the actuator.")]
        private float noiseDecibels = -30f;

        [SerializeField, Min(0f), Tooltip("The device delay is the time from the audio callback to the hand, in ms: " +
            "in the buffers of the audio device, the amplifier and the actuator. Software cannot measure it.")]
        private float deviceDelayMilliseconds = 20f;

        [SerializeField, Tooltip("The device delay is Measured when an oscilloscope or an accelerometer showed it on " +
            "this set-up, else Estimated. Logs and reports name the source.")]
        private DeviceDelaySource deviceDelaySource = DeviceDelaySource.Estimated;

        [SerializeField, Tooltip("The note says how and when the device delay was measured, or what the estimate " +
            "rests on.")]
        private string deviceDelayNote = "assumed by the sample, not measured on this set-up";

        [SerializeField, Tooltip("A simulated session is a rehearsal without a participant. Logs and reports say so.")]
        private bool simulated;

        /// <summary>The order of the trials follows from the seed and the participant's number.</summary>
        public ulong Seed { get => seed; set => seed = value; }

        /// <summary>The folder of the logs. Set to an empty text: <see cref="StudyPlayer.DefaultFolder"/>.</summary>
        public string Folder
        {
            get => folder.Length > 0 ? folder : StudyPlayer.DefaultFolder;
            set => folder = value ?? "";
        }

        /// <summary>The channel of the audio device that the actuator is wired to, from 0.</summary>
        public int HapticChannel { get => hapticChannel; set => hapticChannel = value; }

        /// <summary>The delay from the audio callback to the hand, in ms.</summary>
        public float DeviceDelayMilliseconds { get => deviceDelayMilliseconds; set => deviceDelayMilliseconds = value; }

        /// <summary>Whether the device delay was measured or estimated.</summary>
        public DeviceDelaySource DeviceDelaySource { get => deviceDelaySource; set => deviceDelaySource = value; }

        /// <summary>How the device delay was measured, or what its estimate rests on.</summary>
        public string DeviceDelayNote => deviceDelayNote;

        /// <summary>Whether the session is a rehearsal without a participant.</summary>
        public bool Simulated { get => simulated; set => simulated = value; }

        /// <summary>Headset, audio device and device delay, for the log. Contains nothing about a person. Allocates.
        /// </summary>
        public StudyFields Device()
        {
            AudioSettings.GetDSPBufferSize(out int frames, out _);
            DisplayRate.TryGet(out double hertz);
            return new StudyFields
            {
                { "headset", headset },
                { "refresh_rate_hz", hertz },
                { "output_rate_hz", StudyPlayer.OutputRateHz },
                { "block_frames", frames },
                { "device_delay_ms", (double)deviceDelayMilliseconds },
                { "device_delay_source", deviceDelaySource == DeviceDelaySource.Measured ? "measured" : "estimated" },
                { "device_delay_note", deviceDelayNote },
            };
        }

        /// <summary>Colour and level of the masking noise, for the log.</summary>
        public StudyFields NoiseFields() => new StudyFields
        {
            { "colour", noiseColour == NoiseColour.Pink ? "pink" : "white" }, { "level_db", noiseDecibels },
        };

        /// <summary>Adds the masking noise and a muted haptic output on <see cref="HapticChannel"/> to the object of
        /// the Audio Listener. Main thread.</summary>
        public HapticOutput AddOutput(GameObject listener, out MaskingNoise noise)
        {
            noise = listener.AddComponent<MaskingNoise>();
            noise.Colour = noiseColour;
            noise.LevelDecibels = noiseDecibels;
            // The output follows the noise in Unity's filter chain, because it overwrites its channel.
            var output = listener.AddComponent<HapticOutput>();
            output.Route = OutputRoute.ListenerChannel;
            output.Channel = hapticChannel;
            output.Muted = true;
            noise.Output = output;
            return output;
        }
    }

    /// <summary>What a study needs to know about the running player. Main thread.</summary>
    public static class StudyPlayer
    {
        /// <summary>Default folder for logs: "Studies" in the player's persistent folder.</summary>
        public static string DefaultFolder => Path.Combine(Application.persistentDataPath, "Studies");

        /// <summary>Rate of the audio device, in Hz; 48000 where Unity's audio is switched off.</summary>
        public static int OutputRateHz => UnityAudio.RateHz;

        /// <summary>Duration of an audio block, in ms.</summary>
        public static double BlockMilliseconds
        {
            get
            {
                AudioSettings.GetDSPBufferSize(out int frames, out _);
                return 1000.0 * frames / OutputRateHz;
            }
        }

        /// <summary>Number of channels of the audio device.</summary>
        public static int Channels => SpeakerChannels.Count(AudioSettings.GetConfiguration().speakerMode);

        /// <summary>Application, Unity, package and platform, for the log. Allocates.</summary>
        public static StudyFields Build() => new StudyFields
        {
            { "application", $"{Application.productName} {Application.version}" },
            { "unity", Application.unityVersion },
            { "package", OnnxRuntime.LibraryVersion() },
            { "platform", Application.platform.ToString() },
        };
    }
}
