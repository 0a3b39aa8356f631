#nullable enable
using System.IO;
using UnityEngine;

namespace HaptoFlow.Studies
{
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

        /// <summary>Application, platform and audio device, for the record. Makes garbage.</summary>
        /// <param name="headset">Name of the headset as entered by the operator; empty without one.</param>
        public static StudyEnvironment Environment(string headset)
        {
            AudioSettings.GetDSPBufferSize(out int frames, out _);
            DisplayRate.TryGet(out double hertz);
            return new StudyEnvironment
            {
                Application = $"{Application.productName} {Application.version}",
                Unity = Application.unityVersion,
                Package = OnnxRuntime.LibraryVersion(),
                Platform = Application.platform.ToString(),
                Headset = headset,
                RefreshRateHz = hertz,
                OutputRateHz = OutputRateHz,
                BlockFrames = frames,
            };
        }
    }
}
