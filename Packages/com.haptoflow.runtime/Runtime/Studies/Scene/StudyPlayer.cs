#nullable enable
using System.IO;
using UnityEngine;

namespace HaptoFlow.Studies
{
    /// <summary>What a study asks of the running player. Main thread.</summary>
    public static class StudyPlayer
    {
        /// <summary>Where logs go without another folder: "Studies" in the player's persistent folder.</summary>
        public static string DefaultFolder => Path.Combine(Application.persistentDataPath, "Studies");

        /// <summary>Of an audio block at present, in ms.</summary>
        public static double BlockMilliseconds
        {
            get
            {
                AudioSettings.GetDSPBufferSize(out int frames, out _);
                return 1000.0 * frames / AudioSettings.outputSampleRate;
            }
        }

        /// <summary>Of the audio device at present.</summary>
        public static int Channels => SpeakerChannels.Count(AudioSettings.GetConfiguration().speakerMode);

        /// <summary>Application, platform and audio device, for the record. Makes garbage.</summary>
        /// <param name="headset">The headset in the operator's words; empty without one.</param>
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
                OutputRateHz = AudioSettings.outputSampleRate,
                BlockFrames = frames,
            };
        }
    }
}
