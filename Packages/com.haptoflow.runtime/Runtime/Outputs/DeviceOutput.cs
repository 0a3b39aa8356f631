#nullable enable
using System;
using HaptoFlow.Outputs;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Plays a stylus in the hand that holds it, with the motor or voice coil of the device there. The voice
    /// is rendered on the main thread at the pace of the device; no audio device is needed.</summary>
    /// <remarks>The capabilities of devices are polled: a device that disappears, sleeps or returns as another one is
    /// used according to its present capabilities.</remarks>
    public abstract class DeviceOutput : VoiceOutput, IVoiceTarget
    {
        /// <summary>Assumed acceleration of a controller at its full amplitude, in m/s^2.</summary>
        public const float DefaultFullScaleMps2 = 60f;

        /// <summary>Upper limit of <see cref="DeviceLoudness"/>.</summary>
        public const float MaximumDeviceLoudness = 2f;

        private const double SearchIntervalSeconds = 0.5;
        private const double LostSeconds = 0.1;

        [SerializeField, Tooltip("The stylus to play. Leave it empty for the one on this object or above it.")]
        private HapticStylus? stylus;

        [SerializeField, Tooltip("The hand whose device plays. None uses the hand that holds the stylus.")]
        private HapticHand hand = HapticHand.None;

        [SerializeField, Range(0f, MaximumDeviceLoudness), Tooltip("How strongly the device plays: 1 is fitted so that " +
            "every shipped label is felt, 0 is silent. It has no effect with True Level.")]
        private float deviceLoudness = 1f;

        [SerializeField, Tooltip("Drives the device in proportion to the acceleration, by Full Scale, instead of by " +
            "how strong it is felt. Most textures are then too weak for a small motor.")]
        private bool trueLevel;

        [SerializeField, Min(0.1f), Tooltip("The acceleration that drives the device at its full amplitude, in " +
            "m/s^2. It has an effect with True Level only.")]
        private float fullScaleMps2 = DefaultFullScaleMps2;

        private readonly VoiceSource source = new VoiceSource();
        private readonly HeldDevice device = new HeldDevice();
        // Recompiling while playing keeps the values of serialisable fields. The values of these would be out of date.
        [NonSerialized]
        private HapticStylus? attached;
        [NonSerialized]
        private HapticStylus? namedIn;
        [NonSerialized]
        private HapticHand openedFor;
        private double nextSearchSeconds;
        private bool wasThere;

        /// <summary>The stylus to play; null for the one on this object or above it.</summary>
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

        /// <summary>The stylus that the output plays, or would play if it were enabled; null without one.</summary>
        internal HapticStylus? Played => Wanted();

        /// <summary>The hand whose device is used; <see cref="HapticHand.None"/> for the stylus's.</summary>
        public HapticHand Hand { get => hand; set => hand = value; }

        /// <summary>How strongly the device plays, 0 to <see cref="MaximumDeviceLoudness"/>: a gain after the loudness
        /// law. Has no effect with <see cref="TrueLevel"/>.</summary>
        public float DeviceLoudness
        {
            get => deviceLoudness;
            set => deviceLoudness = Mathf.Clamp(value, 0f, MaximumDeviceLoudness);
        }

        /// <summary>True to drive the device in proportion to the acceleration, by <see cref="FullScaleMps2"/>, instead
        /// of by the loudness law.</summary>
        public bool TrueLevel { get => trueLevel; set => trueLevel = value; }

        /// <summary>Acceleration that drives the device at its full amplitude, in m/s^2, above 0; used with <see
        /// cref="TrueLevel"/>.</summary>
        public float FullScaleMps2 { get => fullScaleMps2; set => fullScaleMps2 = Mathf.Max(0.1f, value); }

        /// <summary>True while a device is connected that supports this output.</summary>
        public bool HasDevice => device.IsThere;

        /// <summary>Name of the device in use, for people; empty without one.</summary>
        public string DeviceName => HasDevice ? device.Sink!.Name : "";

        /// <summary>The form in which the device is driven; null without one.</summary>
        public HapticForm? Form => HasDevice ? device.Form : (HapticForm?)null;

        /// <summary>The hand whose device is searched for: the field's, else the stylus's.</summary>
        internal HapticHand SearchedHand =>
            hand != HapticHand.None ? hand : attached != null ? attached.Hand : HapticHand.None;

        /// <summary>Statistics since the device was connected.</summary>
        public HapticQueueStatistics Statistics => device.Queue?.Statistics ?? default;

        bool IVoiceTarget.PlaysSignal => false;

        int IVoiceTarget.SampleRateHz => (int)WaveHistory.RateHz;

        void IVoiceTarget.Add(HapticVoice voice)
        {
            Adopt(voice);
            source.Add(voice);
        }

        internal override void ForEachVoice<T>(Action<HapticVoice, T> act, T argument) => source.ForEach(act, argument);

        /// <summary>Discards submitted samples, and the fade with which the voices close.</summary>
        private protected override void Silence(bool isSilent)
        {
            if (isSilent)
            {
                source.Discard();
                device.Flush();
            }
        }

        /// <summary>True for an output created for a stylus without one.</summary>
        internal virtual bool IsMade => false;

        private protected virtual bool MayReplace => true;

        /// <summary>Opens the sinks to try, in order of preference.</summary>
        private protected abstract void OpenSinks(HapticHand wanted, HeldDevice into);

        private protected virtual void OnDevice(HapticForm form, IHapticSink sink, HapticHand held)
        {
        }

        private protected void FindDevice()
        {
            HapticHand held = SearchedHand;
            if (held != openedFor)
            {
                device.Close();
                openedFor = held;
                if (held != HapticHand.None)
                {
                    OpenSinks(held, device);
                }
            }
            if (device.Find(source, MayReplace))
            {
                wasThere = false;
                OnDevice(device.Form, device.Sink!, held);
            }
        }

        private void OnEnable()
        {
            ReadPause();
            Attach();
            nextSearchSeconds = 0.0;
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
            device.Flush();
            Detach();
        }

        private void OnDestroy()
        {
            device.Close();
            Name(null);
        }

        // Runs after the styluses have published: see the execution order of each output.
        private void LateUpdate()
        {
            FollowPause();
            double now = Time.realtimeSinceStartupAsDouble;
            if (wasThere && !HasDevice)
            {
                // Another route may reach a device that this one has lost, unless it is back at once.
                wasThere = false;
                nextSearchSeconds = now + LostSeconds;
            }
            if (now >= nextSearchSeconds)
            {
                nextSearchSeconds = now + SearchIntervalSeconds;
                Attach();
                FindDevice();
            }
            if (device.Queue is { } queue)
            {
                HaptoFlowSettings settings = HaptoFlowSettings.Active;
                queue.TrueLevel = trueLevel;
                queue.Gain = trueLevel ? settings.FullScaleMps2 / fullScaleMps2 : deviceLoudness;
                queue.Ceiling = settings.Ceiling;
                queue.FullScaleMps2 = settings.FullScaleMps2;
                bool isThere = HasDevice;
                if (isThere && !wasThere)
                {
                    source.Forget(IsPaused);
                }
                wasThere = isThere;
                queue.YieldUntilSeconds = HandYields.UntilSeconds(openedFor);
                queue.Update(now);
            }
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
    }
}
