#nullable enable
using System;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.Audio;

namespace HaptoFlow
{
    /// <summary>How an output reaches the audio device.</summary>
    public enum OutputRoute
    {
        /// <summary>A playing audio source without clip on this object: the haptic channel also carries what other
        /// sources play.</summary>
        AudioSource,

        /// <summary>A filter on the audio listener that overwrites one channel: nothing else is heard there. Put the
        /// output on the listener's object, below every other filter.</summary>
        ListenerChannel,

        /// <summary>The mixer effect "HaptoFlow Voice": the native library plays inside an Audio Mixer, this component
        /// tells the effect which voice. One stylus for each output.</summary>
        MixerEffect,
    }

    /// <summary>Feeds the haptic waves of styluses into Unity's audio output.</summary>
    [AddComponentMenu("HaptoFlow/Haptic Output")]
    [DisallowMultipleComponent]
    [HelpURL(HelpPages.Components + "haptic-output")]
    public sealed class HapticOutput : MonoBehaviour
    {
        private static readonly List<HapticOutput> Enabled = new List<HapticOutput>();

        [SerializeField]
        private OutputRoute route = OutputRoute.AudioSource;

        [SerializeField, Min(-1), Tooltip("Output channel, from 0; -1 for all.")]
        private int channel = HapticVoice.AllChannels;

        [SerializeField, Range(0f, 1f)]
        private float strength = 1f;

        [SerializeField]
        private bool muted;

        [SerializeField, Tooltip("Mixer effect: the mixer that holds the effect.")]
        private AudioMixer? audioMixer;

        [SerializeField, Tooltip("Mixer effect: the name under which the effect's parameter Voice is exposed.")]
        private string voiceParameter = "HaptoFlowVoice";

        private readonly VoiceMixer mixer = new VoiceMixer();
        private readonly OutputMeter meter = new OutputMeter();
        private AudioSource? source;
        private bool started;
        private volatile int sampleRateHz = 48000;
        private volatile int renderedChannel;
        private volatile bool renderedElsewhere;

        /// <summary>Can be chosen until the output's first frame.</summary>
        public OutputRoute Route
        {
            get => route;
            set => route = started
                ? throw new InvalidOperationException("HaptoFlow: an output's route is chosen before its first frame")
                : value;
        }

        /// <summary>The mixer that holds the mixer effect, and the name under which the effect's parameter Voice is
        /// exposed there. To be called before a stylus uses the output.</summary>
        public void SetMixer(AudioMixer holder, string exposedVoiceParameter)
        {
            audioMixer = holder;
            voiceParameter = exposedVoiceParameter;
        }

        /// <summary>Output channel, from 0; -1 for all. A channel that the device does not have is silent.</summary>
        public int Channel
        {
            get => channel;
            set
            {
                channel = value;
                renderedChannel = value;
            }
        }

        /// <summary>Gain, 0 to 1.</summary>
        public float Strength
        {
            get => strength;
            set => strength = Mathf.Clamp01(value);
        }

        /// <summary>Muted, an output is silent and costs no inference.</summary>
        public bool Muted
        {
            get => muted;
            set
            {
                muted = value;
                mixer.ForEach((voice, on) => voice.SetMuted(on), muted);
            }
        }

        /// <summary>Of the device, in Hz.</summary>
        public int SampleRateHz => sampleRateHz;

        /// <summary>Largest magnitude of the last blocks, 0 to 1.</summary>
        public float Level => meter.Peak;

        /// <summary>What rendering the last block took, in ms.</summary>
        public float RenderMilliseconds => meter.Milliseconds;

        /// <summary>The most that rendering a block took, in ms.</summary>
        public float WorstRenderMilliseconds => meter.WorstMilliseconds;

        /// <summary>Silence at once; each stylus sounds again with its next touch-down.</summary>
        public void Panic() => mixer.ForEach((voice, _) => voice.Panic(), 0);

        /// <summary>The scene's output; where there is none, one is made that outlives scenes.</summary>
        internal static HapticOutput ForStylus(HapticStylus stylus)
        {
            if (Enabled.Count > 0)
            {
                return Enabled[0];
            }
            var owner = new GameObject("HaptoFlow Output");
            DontDestroyOnLoad(owner);
            Debug.Log("HaptoFlow: the scene has no Haptic Output, so one was made that plays on every channel of the " +
                "audio device. Add one to choose a channel.", stylus);
            return owner.AddComponent<HapticOutput>();
        }

        internal void Add(HapticVoice voice)
        {
            voice.SetMuted(muted);
            mixer.Add(voice);
            if (route == OutputRoute.MixerEffect)
            {
                NameVoice(voice);
            }
        }

        internal void Remove(HapticVoice voice) => mixer.Remove(voice);

        /// <summary>Does something with every voice that sounds here. Main thread.</summary>
        internal void ForEachVoice<T>(Action<HapticVoice, T> act, T argument) => mixer.ForEach(act, argument);

        private void NameVoice(HapticVoice voice)
        {
            bool named = audioMixer != null && audioMixer.SetFloat(voiceParameter, voice.Place());
            if (!named)
            {
                Debug.LogWarning($"HaptoFlow: {name} names no mixer that exposes a parameter \"{voiceParameter}\": " +
                    "expose the parameter Voice of the effect HaptoFlow Voice under that name.", this);
            }
        }

        private void OnEnable()
        {
            Channel = channel;
            renderedElsewhere = route == OutputRoute.MixerEffect;
            ReadConfiguration();
            AudioSettings.OnAudioConfigurationChanged += OnConfigurationChanged;
            if (!Enabled.Contains(this))
            {
                Enabled.Add(this);
            }
            if (started)
            {
                PlaySource();
            }
        }

        private void Start()
        {
            started = true;
            renderedElsewhere = route == OutputRoute.MixerEffect;
            PlaySource();
        }

        private void OnDisable()
        {
            AudioSettings.OnAudioConfigurationChanged -= OnConfigurationChanged;
            Enabled.Remove(this);
            if (source != null)
            {
                source.Stop();
            }
        }

        private void OnApplicationPause(bool paused) => mixer.ForEach((voice, on) => voice.SetPaused(on), paused);

        private void OnValidate() => Channel = channel;

        private void OnConfigurationChanged(bool deviceWasChanged)
        {
            ReadConfiguration();
            if (source != null)
            {
                // A change of configuration stops every source.
                source.Play();
            }
        }

        private void ReadConfiguration()
        {
            sampleRateHz = AudioSettings.outputSampleRate;
            AudioSettings.GetDSPBufferSize(out int blockFrames, out _);
            mixer.Prepare(blockFrames);
        }

        private void PlaySource()
        {
            if (route != OutputRoute.AudioSource)
            {
                return;
            }
            if (source == null && !TryGetComponent(out source))
            {
                source = gameObject.AddComponent<AudioSource>();
            }
            source!.playOnAwake = false;
            source.spatialBlend = 0f;
            source.priority = 0;
            source.dopplerLevel = 0f;
            source.bypassReverbZones = true;
            source.Play();
        }

        // Audio thread: no garbage, no wait.
        private void OnAudioFilterRead(float[] data, int channels)
        {
            int wanted = renderedChannel;
            if (wanted >= channels || renderedElsewhere)
            {
                return;
            }
            using (Markers.Render.Auto())
            {
                meter.Begin();
                mixer.Render(data, channels, wanted, sampleRateHz);
                meter.End(data, channels, wanted);
            }
        }

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Forget() => Enabled.Clear();
    }
}
