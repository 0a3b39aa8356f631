using UnityShim;

namespace UnityEngine
{
    public enum AudioSpeakerMode
    {
        Mono = 1,
        Stereo = 2,
        Quad = 3,
        Surround = 4,
        Mode5point1 = 5,
        Mode7point1 = 6,
    }

    public struct AudioConfiguration
    {
        public AudioSpeakerMode speakerMode;
        public int dspBufferSize;
        public int sampleRate;
    }

    public sealed class AudioSettings
    {
        public delegate void AudioConfigurationChangeHandler(bool deviceWasChanged);

        public static event AudioConfigurationChangeHandler? OnAudioConfigurationChanged
        {
            add => AudioDevice.ConfigurationChanged += value;
            remove => AudioDevice.ConfigurationChanged -= value;
        }

        public static int outputSampleRate
        {
            get
            {
                World.RequireMainThread();
                return AudioDevice.IsSwitchedOff ? 0 : AudioDevice.Configuration.sampleRate;
            }
        }

        public static double dspTime => AudioDevice.DspSeconds;

        public static void GetDSPBufferSize(out int bufferLength, out int numBuffers)
        {
            World.RequireMainThread();
            bufferLength = AudioDevice.Configuration.dspBufferSize;
            numBuffers = 4;
        }

        public static AudioConfiguration GetConfiguration()
        {
            World.RequireMainThread();
            return AudioDevice.Configuration;
        }

        public static bool Reset(AudioConfiguration config)
        {
            World.RequireMainThread();
            AudioDevice.Restart(config, false);
            return true;
        }
    }

    public class AudioBehaviour : Behaviour
    {
    }

    public sealed class AudioListener : AudioBehaviour
    {
        public static float volume { get; set; } = 1f;
        public static bool pause { get; set; }
    }

    public sealed class AudioSource : AudioBehaviour
    {
        internal readonly int Generation = AudioDevice.Generation;
        internal bool Playing;

        public AudioClip? clip { get; set; }
        public int timeSamples { get; set; }
        public float panStereo { get; set; }
        public float volume { get; set; } = 1f;
        public float spatialBlend { get; set; }
        public int priority { get; set; } = 128;
        public bool loop { get; set; }
        public bool playOnAwake { get; set; } = true;
        public bool bypassEffects { get; set; }
        public bool bypassListenerEffects { get; set; }
        public bool bypassReverbZones { get; set; }
        public bool ignoreListenerPause { get; set; }
        public bool ignoreListenerVolume { get; set; }
        public float dopplerLevel { get; set; } = 1f;
        public bool isPlaying => Playing && isActiveAndEnabled;

        public void Play()
        {
            World.RequireMainThread();
            Playing = !AudioDevice.IsSwitchedOff && !AudioDevice.IgnoresPlay;
        }

        public void Stop()
        {
            World.RequireMainThread();
            Playing = false;
        }
    }
}

namespace UnityEngine.Audio
{
    public class AudioMixer : Object
    {
        internal readonly System.Collections.Generic.Dictionary<string, float> Exposed =
            new System.Collections.Generic.Dictionary<string, float>();

        internal AudioMixer()
        {
        }

        public bool SetFloat(string name, float value)
        {
            bool known = Exposed.ContainsKey(name);
            if (known)
            {
                Exposed[name] = value;
            }
            return known;
        }
    }
}
