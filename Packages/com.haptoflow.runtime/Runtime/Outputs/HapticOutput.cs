#nullable enable
using System;
using UnityEngine;
using UnityEngine.Audio;

namespace HaptoFlow
{
    /// <summary>How an output reaches the audio device.</summary>
    public enum OutputRoute
    {
        /// <summary>A playing audio source without clip on this object. The haptic channel also carries what other
        /// sources play.</summary>
        AudioSource,

        /// <summary>A filter on the audio listener that overwrites one channel, which then carries nothing else. Put
        /// the output on the listener's object, below every other filter.</summary>
        ListenerChannel,

        /// <summary>The mixer effect "HaptoFlow Voice": the native library plays inside an Audio Mixer, and this
        /// component sets the effect's voice. One stylus for each output.</summary>
        MixerEffect,
    }

    /// <summary>Plays the vibration of styluses through Unity's audio output.</summary>
    [AddComponentMenu("HaptoFlow/Haptic Output")]
    [DisallowMultipleComponent]
    [HelpPage(HelpPages.Components + "haptic-output")]
    public sealed class HapticOutput : MonoBehaviour, IVoiceTarget
    {
        [SerializeField, Tooltip("The route leads the wave to the audio device. Audio Source plays beside other " +
            "sounds. Listener Channel overwrites one channel. Mixer Effect plays inside an Audio Mixer. The route is " +
            "fixed once the scene plays.")]
        private OutputRoute route = OutputRoute.AudioSource;

        [SerializeField, Min(-1), Tooltip("The wave plays on this channel of the audio device, counted from 0; -1 " +
            "plays on all channels. A channel that the device does not have is silent. The route Listener Channel " +
            "needs a channel from 0.")]
        private int channel = HapticVoice.AllChannels;

        [SerializeField, Range(0f, 1f), Tooltip("Strength is the gain of this output, from 0 to 1.")]
        private float strength = 1f;

        [SerializeField, Tooltip("A muted output is silent, and runs no inference.")]
        private bool muted;

        [SerializeField, Tooltip("AudioListener.pause and AudioListener.volume also apply to the haptics. When it is " +
            "off, the haptics stay as they are when a game turns its sound down.")]
        private bool obeyListener;

        [SerializeField, Tooltip("The Audio Mixer contains the effect HaptoFlow Voice.")]
        private AudioMixer? audioMixer;

        [SerializeField, Tooltip("The mixer exposes the effect's parameter Voice under this name.")]
        private string voiceParameter = "HaptoFlowVoice";

        [SerializeField]
        private OutputProcessing processing = new OutputProcessing();

        // Serialised, so that it survives a recompilation while playing.
        [SerializeField, HideInInspector]
        private bool isMade;

        private readonly VoiceMixer mixer = new VoiceMixer();
        private readonly OutputMeter meter = new OutputMeter();
        private AudioSource? source;
        private double signalHz;
        private double signalMps2;
        private bool started;
        private bool isBesideListener;
        private volatile int sampleRateHz = 48000;
        private volatile int renderedChannel;
        private volatile bool rendersHere;

        /// <summary>The route; it can be set until the output's first frame.</summary>
        public OutputRoute Route
        {
            get => route;
            set => route = started
                ? throw new InvalidOperationException("HaptoFlow: set an output's route before its first frame")
                : value;
        }

        /// <summary>Sets the mixer that contains the mixer effect, and the name under which the effect's parameter
        /// Voice is exposed there. Call it before a stylus uses the output.</summary>
        public void SetMixer(AudioMixer holder, string exposedVoiceParameter)
        {
            audioMixer = holder;
            voiceParameter = exposedVoiceParameter;
        }

        /// <summary>Output channel, from 0; -1 for all. A channel that the device does not have is silent. <see
        /// cref="OutputRoute.ListenerChannel"/> needs a channel of its own: with -1 it would overwrite everything that
        /// the player hears, so the output stays silent and logs an error.</summary>
        public int Channel
        {
            get => channel;
            set
            {
                channel = value;
                UpdateRendering();
                // Listen depends on the channel.
                ApplyProcessing();
                if (started)
                {
                    ReportMissingChannel();
                }
            }
        }

        /// <summary>True to apply AudioListener.pause and AudioListener.volume to the haptics as well, with <see
        /// cref="OutputRoute.AudioSource"/>. Off by default: a game that lowers or pauses its sound keeps its
        /// haptics.</summary>
        public bool ObeyListener
        {
            get => obeyListener;
            set
            {
                obeyListener = value;
                ConfigureSource();
            }
        }

        /// <summary>Gain, 0 to 1.</summary>
        public float Strength { get => strength; set => strength = Mathf.Clamp01(value); }

        /// <summary>A muted output is silent and costs no inference.</summary>
        public bool Muted
        {
            get => muted;
            set
            {
                muted = value;
                mixer.ForEach((voice, on) => voice.SetMuted(on), muted);
            }
        }

        /// <summary>Processing between the voices and the device. Call <see cref="ApplyProcessing"/> after a
        /// change.</summary>
        public OutputProcessing Processing => processing;

        /// <summary>Applies a change of <see cref="Processing"/> to the open voices of this output; new voices have it
        /// from the start.</summary>
        public void ApplyProcessing() =>
            mixer.ForEach((voice, output) => output.processing.Apply(voice, output), this);

        /// <summary>Plays a sine instead of everything else, for studies of latency. It sounds while a tip touches and
        /// moves, whatever the speed and the force. Motion begins above 30 mm/s and ends below 15 mm/s, measured
        /// between two frames, on a surface at rest. Not saved with the scene.</summary>
        /// <param name="frequencyHz">Frequency, 20 to 500 Hz; ignored where the amplitude is 0.</param>
        /// <param name="amplitudeMps2">Peak amplitude, 0 to 60 m/s^2; 0 for no signal.</param>
        /// <exception cref="ArgumentOutOfRangeException">A value is out of range.</exception>
        public void SetSignal(double frequencyHz, double amplitudeMps2)
        {
            if (!(amplitudeMps2 >= 0.0 && amplitudeMps2 <= HapticVoice.MaximumSignalMps2))
            {
                throw new ArgumentOutOfRangeException(nameof(amplitudeMps2), amplitudeMps2,
                    FormattableString.Invariant($"expected 0 to {HapticVoice.MaximumSignalMps2} m/s^2"));
            }
            if (amplitudeMps2 > 0.0 && !(frequencyHz >= HapticVoice.MinimumSignalHz &&
                frequencyHz <= HapticVoice.MaximumSignalHz))
            {
                throw new ArgumentOutOfRangeException(nameof(frequencyHz), frequencyHz, FormattableString.Invariant(
                    $"expected {HapticVoice.MinimumSignalHz} to {HapticVoice.MaximumSignalHz} Hz"));
            }
            signalHz = frequencyHz;
            signalMps2 = amplitudeMps2;
            mixer.ForEach((voice, output) => voice.SetSignal(output.signalHz, output.signalMps2), this);
        }

        /// <summary>Sample rate of the device, in Hz.</summary>
        public int SampleRateHz => sampleRateHz;

        /// <summary>Peak magnitude of the last blocks, 0 to 1.</summary>
        public float Level => meter.Peak;

        /// <summary>Time to render the last block, in ms.</summary>
        public float RenderMilliseconds => meter.Milliseconds;

        /// <summary>Longest time to render a block, in ms.</summary>
        public float WorstRenderMilliseconds => meter.WorstMilliseconds;

        /// <summary>Silences the output at once; each stylus sounds again with its next touch-down.</summary>
        public void Panic() => mixer.ForEach((voice, _) => voice.Panic(), 0);

        /// <summary>True for an output created automatically for a scene without one.</summary>
        internal bool IsMade => isMade;

        /// <summary>True where the author chose a channel, as for a wired actuator: the output then takes every stylus
        /// that names no other. An output on all channels is for loudspeakers, and leaves a stylus in a hand to the
        /// device there.</summary>
        internal bool HasOwnChannel => route != OutputRoute.AudioSource || channel >= 0;

        /// <summary>Creates an output for <see cref="SceneOutputs"/>; <see cref="IsMade"/> is set before its
        /// Awake.</summary>
        internal static HapticOutput Make()
        {
            var owner = new GameObject("HaptoFlow Output");
            owner.SetActive(false);
            var made = owner.AddComponent<HapticOutput>();
            made.isMade = true;
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

        /// <summary>Records every block; null for none.</summary>
        internal DeviceCheck.BlockRecorder? Recorder
        {
            set => meter.Recorder = value;
        }

        /// <summary>Calls an action with every voice of this output. Main thread.</summary>
        internal void ForEachVoice<T>(Action<HapticVoice, T> act, T argument) => mixer.ForEach(act, argument);

        private void NameVoice(HapticVoice voice)
        {
            bool named = audioMixer != null && audioMixer.SetFloat(voiceParameter, voice.Place());
            if (!named)
            {
                Debug.LogWarning($"HaptoFlow: {name} has no mixer that exposes a parameter \"{voiceParameter}\": " +
                    "expose the parameter Voice of the effect HaptoFlow Voice under that name.", this);
            }
        }

        private void Awake() => SceneOutputs.OnOutputAwake(this);

        private void OnEnable()
        {
            UpdateRendering();
            ReadConfiguration();
            AudioSettings.OnAudioConfigurationChanged += OnConfigurationChanged;
            SceneOutputs.Add(this);
            if (started)
            {
                PlaySource();
                ReportMissingChannel();
            }
        }

        private void Start()
        {
            started = true;
            UpdateRendering();
            PlaySource();
            ReportMissingChannel();
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
            UpdateRendering();
            ConfigureSource();
        }

        private bool LacksChannel => route == OutputRoute.ListenerChannel && channel < 0;

        private void UpdateRendering()
        {
            renderedChannel = channel;
            rendersHere = route != OutputRoute.MixerEffect && !LacksChannel && !isBesideListener;
        }

        private void ReportMissingChannel()
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
        }

        private void PlaySource()
        {
            if (route != OutputRoute.AudioSource)
            {
                return;
            }
            if (source == null)
            {
                source = FindSource();
            }
            source.playOnAwake = false;
            source.spatialBlend = 0f;
            source.priority = 0;
            source.dopplerLevel = 0f;
            source.bypassReverbZones = true;
            source.bypassListenerEffects = true;
            // This component is itself a filter of the source.
            source.bypassEffects = false;
            ConfigureSource();
            source.Play();
        }

        /// <summary>The source on this object. Beside an Audio Listener this component would filter what the listener
        /// hears, and overwrite it; there the source gets an object of its own.</summary>
        private AudioSource FindSource()
        {
            if (TryGetComponent(out AudioListener _))
            {
                isBesideListener = true;
                UpdateRendering();
                return OutputSource.Of(this);
            }
            return TryGetComponent(out AudioSource found) ? found : gameObject.AddComponent<AudioSource>();
        }

        private void ConfigureSource()
        {
            if (source != null)
            {
                source.ignoreListenerPause = !obeyListener;
                source.ignoreListenerVolume = !obeyListener;
            }
        }

        // Audio thread: no garbage, no locks.
        private void OnAudioFilterRead(float[] data, int channels)
        {
            if (rendersHere)
            {
                Render(data, channels);
            }
        }

        /// <summary>Overwrites the output's channel of a block with the voices. Audio thread.</summary>
        internal void Render(float[] data, int channels)
        {
            int wanted = renderedChannel;
            if (wanted >= channels)
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
