#nullable enable
using System;
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
    public sealed class HapticOutput : MonoBehaviour, IVoiceTarget
    {
        [SerializeField]
        private OutputRoute route = OutputRoute.AudioSource;

        [SerializeField, Min(-1), Tooltip("Output channel, from 0; -1 for all (not for Listener Channel).")]
        private int channel = HapticVoice.AllChannels;

        [SerializeField, Range(0f, 1f)]
        private float strength = 1f;

        [SerializeField]
        private bool muted;

        [SerializeField, Tooltip("Audio Source: AudioListener.pause and AudioListener.volume reach the haptics too.")]
        private bool obeyListener;

        [SerializeField, Tooltip("Mixer effect: the mixer that holds the effect.")]
        private AudioMixer? audioMixer;

        [SerializeField, Tooltip("Mixer effect: the name under which the effect's parameter Voice is exposed.")]
        private string voiceParameter = "HaptoFlowVoice";

        [SerializeField]
        private OutputProcessing processing = new OutputProcessing();

        private readonly VoiceMixer mixer = new VoiceMixer();
        private readonly OutputMeter meter = new OutputMeter();
        private AudioSource? source;
        private double signalHz;
        private double signalMps2;
        private bool started;
        private volatile int sampleRateHz = 48000;
        private volatile int renderedChannel;
        private volatile bool rendersHere;

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

        /// <summary>Output channel, from 0; -1 for all. A channel that the device does not have is silent.
        /// <see cref="OutputRoute.ListenerChannel"/> needs a channel of its own: with -1 it would overwrite everything
        /// that the player hears, so it stays silent and logs an error.</summary>
        public int Channel
        {
            get => channel;
            set
            {
                channel = value;
                DecideRendering();
                if (started)
                {
                    RefuseMissingChannel();
                }
            }
        }

        /// <summary>With <see cref="OutputRoute.AudioSource"/>: AudioListener.pause and AudioListener.volume reach the
        /// haptics too. Off by default: a game that turns its sound down or pauses it keeps what the hand feels.
        /// </summary>
        public bool ObeyListener
        {
            get => obeyListener;
            set
            {
                obeyListener = value;
                TellSource();
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

        /// <summary>What the voices go through on their way to the device. Call <see cref="ApplyProcessing"/> after a
        /// change.</summary>
        public OutputProcessing Processing => processing;

        /// <summary>Hands a change of <see cref="Processing"/> to the voices that sound here; new ones have it by
        /// themselves.</summary>
        public void ApplyProcessing() =>
            mixer.ForEach((voice, output) => output.processing.Apply(voice, output), this);

        /// <summary>A sine for studies of latency, in the place of everything else: it sounds while a tip touches and
        /// moves, whatever speed and force are. A tip sets off at 30 mm/s and comes to rest below 15 mm/s, from one
        /// frame to the next, on a surface that stands still. Not kept with the scene.</summary>
        /// <param name="frequencyHz">20 to 500; ignored where the amplitude is 0.</param>
        /// <param name="amplitudeMps2">Its peak, 0 to 60 m/s^2; 0 for no signal.</param>
        /// <exception cref="ArgumentOutOfRangeException">A value is out of range.</exception>
        public void SetSignal(double frequencyHz, double amplitudeMps2)
        {
            if (!(amplitudeMps2 >= 0.0 && amplitudeMps2 <= 60.0))
            {
                throw new ArgumentOutOfRangeException(nameof(amplitudeMps2), amplitudeMps2, "expected 0 to 60 m/s^2");
            }
            if (amplitudeMps2 > 0.0 && !(frequencyHz >= 20.0 && frequencyHz <= 500.0))
            {
                throw new ArgumentOutOfRangeException(nameof(frequencyHz), frequencyHz, "expected 20 to 500 Hz");
            }
            signalHz = frequencyHz;
            signalMps2 = amplitudeMps2;
            mixer.ForEach((voice, output) => voice.SetSignal(output.signalHz, output.signalMps2), this);
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

        /// <summary>Made for a scene without output.</summary>
        internal bool IsMade { get; private set; }

        /// <summary>An output as <see cref="SceneOutputs"/> makes it: it counts as made before it wakes.</summary>
        internal static HapticOutput Make()
        {
            var owner = new GameObject("HaptoFlow Output");
            owner.SetActive(false);
            var made = owner.AddComponent<HapticOutput>();
            made.IsMade = true;
            owner.SetActive(true);
            return made;
        }

        bool IVoiceTarget.PlaysSignal => signalMps2 > 0.0;

        void IVoiceTarget.Add(HapticVoice voice)
        {
            voice.SetMuted(muted);
            processing.Apply(voice, this);
            voice.SetSignal(signalHz, signalMps2);
            mixer.Add(voice);
            if (route == OutputRoute.MixerEffect)
            {
                NameVoice(voice);
            }
        }

        void IVoiceTarget.Remove(HapticVoice voice) => mixer.Remove(voice);

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

        private void Awake() => SceneOutputs.Woke(this);

        private void OnEnable()
        {
            DecideRendering();
            ReadConfiguration();
            AudioSettings.OnAudioConfigurationChanged += OnConfigurationChanged;
            SceneOutputs.Add(this);
            if (started)
            {
                PlaySource();
                RefuseMissingChannel();
            }
        }

        private void Start()
        {
            started = true;
            DecideRendering();
            PlaySource();
            RefuseMissingChannel();
        }

        private void OnDisable()
        {
            AudioSettings.OnAudioConfigurationChanged -= OnConfigurationChanged;
            SceneOutputs.Remove(this);
            if (source != null)
            {
                source.Stop();
            }
        }

        private void OnApplicationPause(bool paused) => mixer.ForEach((voice, on) => voice.SetPaused(on), paused);

        private void OnValidate()
        {
            DecideRendering();
            TellSource();
        }

        private bool LacksChannel => route == OutputRoute.ListenerChannel && channel < 0;

        private void DecideRendering()
        {
            renderedChannel = channel;
            rendersHere = route != OutputRoute.MixerEffect && !LacksChannel;
        }

        private void RefuseMissingChannel()
        {
            if (LacksChannel)
            {
                Debug.LogError($"HaptoFlow: {name} is silent: the route Listener Channel overwrites a channel of its " +
                    "own, and channel -1 would overwrite all that the player hears. Choose a channel from 0.", this);
            }
        }

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
            TellSource();
            source.Play();
        }

        private void TellSource()
        {
            if (source != null)
            {
                source.ignoreListenerPause = !obeyListener;
                source.ignoreListenerVolume = !obeyListener;
            }
        }

        // Audio thread: no garbage, no wait.
        private void OnAudioFilterRead(float[] data, int channels)
        {
            int wanted = renderedChannel;
            if (wanted >= channels || !rendersHere)
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
    }
}
