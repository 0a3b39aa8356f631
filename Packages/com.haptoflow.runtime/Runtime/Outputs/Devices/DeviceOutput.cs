#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Outputs;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Makes a stylus felt in the hand that holds it, through the motor or voice coil of the device there. The
    /// stylus's voice is rendered on the main thread, as fast as the device plays: no audio device is needed.</summary>
    /// <remarks>Devices are asked what they take, again and again: one that vanishes, sleeps or comes back as another is
    /// played as what it is then.</remarks>
    public abstract class DeviceOutput : MonoBehaviour, IVoiceTarget
    {
        /// <summary>What a controller is taken to play at its full amplitude, in m/s^2.</summary>
        public const float DefaultFullScaleMps2 = 60f;

        private const double LookSeconds = 0.5;

        [SerializeField, Tooltip("The stylus that is felt; empty for the one on this object or above it.")]
        private HapticStylus? stylus;

        [SerializeField, Tooltip("The hand whose device is used; None for the hand that holds the stylus.")]
        private HapticHand hand = HapticHand.None;

        [SerializeField, Range(0f, 1f), Tooltip("Gain, on top of the surface's and the stylus's.")]
        private float strength = 1f;

        [SerializeField, Tooltip("A muted output is silent and costs no inference.")]
        private bool muted;

        [SerializeField, Min(0.1f), Tooltip("Acceleration that drives the device at its full amplitude, in m/s^2. " +
            "Lower it where textures feel too weak.")]
        private float fullScaleMps2 = DefaultFullScaleMps2;

        private readonly VoiceSource source = new VoiceSource();
        private readonly List<HapticSinks.OpenSink> sinks = new List<HapticSinks.OpenSink>();
        // Recompiling while playing keeps the values of fields that can be serialised. These would be out of date then.
        [NonSerialized]
        private HapticStylus? attached;
        [NonSerialized]
        private HapticStylus? namedIn;
        [NonSerialized]
        private HapticHand openedFor;
        private IHapticSink? device;
        private HapticQueue? queue;
        private double lookAtSeconds;
        private bool wasThere;

        /// <summary>The stylus that is felt; null for the one on this object or above it.</summary>
        public HapticStylus? Stylus
        {
            get => stylus;
            set
            {
                stylus = value;
                if (isActiveAndEnabled)
                {
                    Attach();
                }
            }
        }

        /// <summary>The hand whose device is used; <see cref="HapticHand.None"/> for the stylus's.</summary>
        public HapticHand Hand
        {
            get => hand;
            set => hand = value;
        }

        /// <summary>Gain, 0 to 1.</summary>
        public float Strength
        {
            get => strength;
            set => strength = Mathf.Clamp01(value);
        }

        /// <summary>Muted, an output is silent with this frame and costs no inference.</summary>
        public bool Muted
        {
            get => muted;
            set
            {
                muted = value;
                source.ForEach((voice, on) => voice.SetMuted(on), muted);
                if (muted)
                {
                    CallBack();
                }
            }
        }

        /// <summary>Acceleration that drives the device at its full amplitude, in m/s^2, above 0.</summary>
        public float FullScaleMps2
        {
            get => fullScaleMps2;
            set => fullScaleMps2 = Mathf.Max(0.1f, value);
        }

        /// <summary>A device is there that takes what this output gives.</summary>
        public bool HasDevice => device != null && device.TryGetCapabilities(out _);

        /// <summary>What people call the device in use; empty where there is none.</summary>
        public string DeviceName => HasDevice ? device!.Name : "";

        /// <summary>What the output did so far.</summary>
        public HapticQueueStatistics Statistics => queue?.Statistics ?? default;

        bool IVoiceTarget.PlaysSignal => false;

        int IVoiceTarget.SampleRateHz => (int)WaveHistory.RateHz;

        /// <summary>Silence at once; the stylus sounds again with its next touch-down.</summary>
        public void Panic()
        {
            source.ForEach((voice, _) => voice.Panic(), 0);
            CallBack();
        }

        void IVoiceTarget.Add(HapticVoice voice)
        {
            voice.SetMuted(muted);
            source.Add(voice);
        }

        void IVoiceTarget.Remove(HapticVoice voice) => source.Remove(voice);

        /// <summary>Made by <see cref="SceneOutputs"/> for a stylus without output.</summary>
        internal virtual bool IsMade => false;

        /// <summary>False for submissions that queue behind each other.</summary>
        private protected virtual bool MayReplace => true;

        /// <summary>The sinks that may be used, the best first.</summary>
        private protected abstract void OpenSinks(HapticHand wanted, List<HapticSinks.OpenSink> into);

        /// <summary>Another device is used from now on.</summary>
        private protected virtual void OnDevice(HapticForm form, IHapticSink sink, HapticHand held)
        {
        }

        /// <summary>Looks for a device now. Main thread.</summary>
        private protected void Look()
        {
            HapticHand held = hand != HapticHand.None ? hand : attached != null ? attached.Hand : HapticHand.None;
            if (held != openedFor)
            {
                Close();
                openedFor = held;
                if (held != HapticHand.None)
                {
                    OpenSinks(held, sinks);
                }
            }
            foreach (HapticSinks.OpenSink each in sinks)
            {
                if (each.Sink.TryGetCapabilities(out _))
                {
                    Use(each, held);
                    return;
                }
            }
        }

        private void OnEnable()
        {
            Attach();
            lookAtSeconds = 0.0;
        }

        private void Awake()
        {
            if (!IsMade)
            {
                Name(Wanted());
            }
        }

        private void OnDisable()
        {
            queue?.Flush(Time.realtimeSinceStartupAsDouble);
            Detach();
        }

        private void OnDestroy()
        {
            Close();
            Name(null);
        }

        private void OnApplicationPause(bool paused)
        {
            source.ForEach((voice, on) => voice.SetPaused(on), paused);
            if (paused)
            {
                CallBack();
            }
        }

        // After the styluses have published: the execution order of every output says so.
        private void LateUpdate()
        {
            double now = Time.realtimeSinceStartupAsDouble;
            if (now >= lookAtSeconds)
            {
                lookAtSeconds = now + LookSeconds;
                Attach();
                Look();
            }
            if (queue != null)
            {
                HaptoFlowSettings settings = HaptoFlowSettings.Active;
                queue.Gain = settings.FullScaleMps2 / fullScaleMps2;
                queue.Ceiling = settings.Ceiling;
                queue.FullScaleMps2 = settings.FullScaleMps2;
                bool isThere = HasDevice;
                if (isThere && !wasThere)
                {
                    source.Forget();
                }
                wasThere = isThere;
                queue.Update(now);
            }
        }

        /// <summary>What is on its way is not felt any more, nor what the voices close with.</summary>
        private void CallBack()
        {
            source.Discard();
            queue?.Flush(Time.realtimeSinceStartupAsDouble);
        }

        private HapticStylus? Wanted()
        {
            if (stylus != null)
            {
                return stylus;
            }
            for (Transform? place = transform; place != null; place = place.parent)
            {
                if (place.TryGetComponent(out HapticStylus found))
                {
                    return found;
                }
            }
            return null;
        }

        private void Attach()
        {
            HapticStylus? wanted = Wanted();
            if (!ReferenceEquals(wanted, attached))
            {
                Detach();
                attached = wanted;
                if (wanted != null)
                {
                    wanted.Voices.Add(this);
                }
            }
            if (!IsMade)
            {
                Name(wanted);
            }
        }

        private void Detach()
        {
            if (attached is not null)
            {
                attached.Voices.Remove(this);
                attached = null;
            }
        }

        private void Name(HapticStylus? wanted)
        {
            if (!ReferenceEquals(wanted, namedIn))
            {
                namedIn?.Voices.Name(false);
                namedIn = wanted;
                namedIn?.Voices.Name(true);
            }
        }

        private void Use(in HapticSinks.OpenSink chosen, HapticHand held)
        {
            if (ReferenceEquals(chosen.Sink, device))
            {
                return;
            }
            queue?.Flush(Time.realtimeSinceStartupAsDouble);
            queue?.Dispose();
            device = chosen.Sink;
            wasThere = false;
            queue = chosen.Sink switch
            {
                IWaveformSink waveform => new WaveformQueue(waveform, source, MayReplace),
                IParametricSink parametric => new ParametricQueue(parametric, source),
                IAmplitudeSink amplitude => new AmplitudeQueue(amplitude, source),
                _ => null,
            };
            OnDevice(chosen.Form, chosen.Sink, held);
        }

        private void Close()
        {
            queue?.Flush(Time.realtimeSinceStartupAsDouble);
            queue?.Dispose();
            queue = null;
            device = null;
            foreach (HapticSinks.OpenSink each in sinks)
            {
                (each.Sink as IDisposable)?.Dispose();
            }
            sinks.Clear();
        }
    }
}
