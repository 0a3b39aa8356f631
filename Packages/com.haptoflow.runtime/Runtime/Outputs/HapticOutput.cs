#nullable enable
using System;
using UnityEngine;
using UnityEngine.Audio;

namespace HaptoFlow
{
    /// <summary>How an output reaches the audio device.</summary>
    public enum OutputRoute
    {
        /// <summary>A playing audio source on a child object, which the output makes. The haptic channel also carries
        /// what other sources play.</summary>
        AudioSource,

        /// <summary>A filter on the audio listener that overwrites one channel, which then carries nothing else. Put
        /// the output on the listener's object. The filter is the last of those there when play begins.</summary>
        ListenerChannel,

        /// <summary>The mixer effect "HaptoFlow Voice": the native library plays inside an Audio Mixer, and this
        /// component sets the effect's voice. One stylus for each output.</summary>
        MixerEffect,
    }

    /// <summary>Plays the vibration of styluses through Unity's audio output.</summary>
    [AddComponentMenu("HaptoFlow/Haptic Output")]
    [DisallowMultipleComponent]
    [HelpPage(HelpPages.Components + "haptic-output")]
    public sealed class HapticOutput : VoiceOutput, IVoiceTarget
    {
        [SerializeField, Tooltip("The route leads the wave to the audio device. Audio Source plays beside other " +
            "sounds. Listener Channel overwrites one channel. Mixer Effect plays inside an Audio Mixer. The route is " +
            "fixed once the scene plays.")]
        private OutputRoute route = OutputRoute.AudioSource;

        [SerializeField, Min(-1), Tooltip("The wave plays on this channel of the audio device, counted from 0; -1 " +
            "plays on all channels. A channel that the device does not have is silent. The route Listener Channel " +
            "needs a channel from 0.")]
        private int channel = HapticVoice.AllChannels;

        [SerializeField, Tooltip("AudioListener.volume also applies to the haptics. When it is off, the haptics stay as " +
            "they are when a game turns its sound down.")]
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
        private AudioCalls? calls;
        private CallWatch watch;
        private double signalHz;
        private double signalMps2;
        private bool started;
        private bool isOpen;
        private bool mixerKnowsVoice;
        private volatile int sampleRateHz = 48000;
        private volatile int renderedChannel;
        private volatile int callCount;

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

        /// <summary>True to apply AudioListener.volume to the haptics as well, with <see
        /// cref="OutputRoute.AudioSource"/>. Off by default: a game that lowers its sound keeps its haptics.</summary>
        public bool ObeyListener
        {
            get => obeyListener;
            set
            {
                obeyListener = value;
                calls?.ObeyVolume(value);
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
            Adopt(voice);
            processing.Apply(voice, this);
            voice.SetSignal(signalHz, signalMps2);
            mixer.Add(voice);
            if (route == OutputRoute.MixerEffect)
            {
                NameVoice(voice);
            }
        }

        internal DeviceCheck.BlockRecorder? Recorder
        {
            set => meter.Recorder = value;
        }

        internal override void ForEachVoice<T>(Action<HapticVoice, T> act, T argument) => mixer.ForEach(act, argument);

        /// <summary>Tells the mixer effect which voice to play; where that fails, the console says so.</summary>
        private void NameVoice(HapticVoice voice)
        {
            mixerKnowsVoice = audioMixer != null && audioMixer.SetFloat(voiceParameter, voice.Place());
            if (!mixerKnowsVoice)
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
            ReadPause();
            AudioSettings.OnAudioConfigurationChanged += OnConfigurationChanged;
            SceneOutputs.Add(this);
            if (started)
            {
                ReportMissingChannel();
            }
        }

        private void Start()
        {
            started = true;
            UpdateRendering();
            Open();
            ReportMissingChannel();
        }

        private void Update()
        {
            if (!isOpen)
            {
                Open();
            }
            FollowPause();
            UnityAudio.Poll();
            if (UnityAudio.Problem != null)
            {
                UnityAudio.SayProblem(name, this);
                watch.Restart();
            }
            else if (watch.Misses(CallCount(), AreCallsExpected()))
            {
                SayThatNoCallComes();
                Open();
            }
        }

        private void OnDisable()
        {
            AudioSettings.OnAudioConfigurationChanged -= OnConfigurationChanged;
            SceneOutputs.Remove(this);
            if (gameObject.activeInHierarchy)
            {
                calls?.CloseAfterTheFade();
            }
            else
            {
                // What is on this object, or below it, is switched off with it.
                calls?.Close();
            }
            isOpen = false;
        }

        private void OnValidate()
        {
            UpdateRendering();
            calls?.ObeyVolume(obeyListener);
        }

        private bool LacksChannel => route == OutputRoute.ListenerChannel && channel < 0;

        private void UpdateRendering() => renderedChannel = LacksChannel ? int.MaxValue : channel;

        private void ReportMissingChannel()
        {
            if (LacksChannel)
            {
                Debug.LogError($"HaptoFlow: {name} is silent: the route Listener Channel overwrites a channel of its " +
                    "own, and channel -1 would overwrite all that the player hears. Choose a channel from 0.", this);
            }
        }

        // The engine may have stopped the source, dropped the filter, and loaded the mixers again.
        private void OnConfigurationChanged(bool deviceWasChanged)
        {
            ReadConfiguration();
            watch.Restart();
            if (started)
            {
                Open();
            }
        }

        private void ReadConfiguration()
        {
            sampleRateHz = UnityAudio.RateHz;
        }

        private void Open()
        {
            isOpen = true;
            calls ??= new AudioCalls(Render);
            calls.Open(gameObject, route, obeyListener);
            if (mixerKnowsVoice)
            {
                mixer.ForEach((voice, output) => output.NameVoice(voice), this);
            }
        }

        /// <summary>The native library counts for the mixer effect.</summary>
        private ulong CallCount() => route == OutputRoute.MixerEffect ? mixer.RenderedFrames() : (ulong)callCount;

        private bool AreCallsExpected() => !AudioListener.pause &&
            (route != OutputRoute.MixerEffect || (mixerKnowsVoice && mixer.HasVoices));

        private void SayThatNoCallComes()
        {
            string remedy = route switch
            {
                OutputRoute.ListenerChannel => "put it on the object of the Audio Listener that is in use",
                OutputRoute.MixerEffect => "switch auto-suspend off, on the mixer and its groups",
                _ => "restart the audio with AudioSettings.Reset",
            };
            Debug.LogWarning($"HaptoFlow: {name} is silent: for a second, Unity's audio has not asked it for samples. It " +
                $"tries once more now; if that does not help, {remedy}.", this);
        }

        /// <summary>Overwrites the output's channel of a block with the voices. Audio thread: no garbage, no
        /// locks.</summary>
        internal void Render(float[] data, int channels)
        {
            callCount = unchecked(callCount + 1);
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
