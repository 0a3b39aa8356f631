#nullable enable
using System;
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow
{
    /// <summary>The voices of one stylus: one on an audio output, and one on each device output that references the
    /// stylus. Each output drives the clock of its own voice. Main thread; no garbage while nothing changes.</summary>
    internal sealed class StylusVoices
    {
        private readonly HapticStylus stylus;
        private readonly StylusVoice audio;
        private Device[] devices = Array.Empty<Device>();
        private int named;

        public StylusVoices(HapticStylus stylus)
        {
            this.stylus = stylus;
            audio = new StylusVoice(stylus);
        }

        /// <summary>True where the scene's author assigned a device output to the stylus, enabled or not: none is then
        /// chosen automatically.</summary>
        public bool HasNamedDevices => named > 0;

        /// <summary>The output chosen automatically for this stylus; null where it was not requested.</summary>
        public AutoOutput? Chosen { get; set; }

        /// <summary>The audio output of which the console said that it plays the stylus instead of the device in its
        /// hand; null before.</summary>
        public HapticOutput? LeftOutFor { get; set; }

        /// <summary>Counts a device output that the author assigned to the stylus, or no longer assigns.</summary>
        public void Name(bool names) => named += names ? 1 : -1;

        public void Add(IVoiceTarget target)
        {
            if (!Array.Exists(devices, each => ReferenceEquals(each.Target, target)))
            {
                Array.Resize(ref devices, devices.Length + 1);
                devices[devices.Length - 1] = new Device(target, new StylusVoice(stylus));
            }
        }

        public void Remove(IVoiceTarget target)
        {
            Device[] before = devices;
            devices = Array.FindAll(before, each => !ReferenceEquals(each.Target, target));
            foreach (Device each in before)
            {
                if (ReferenceEquals(each.Target, target))
                {
                    each.Voice.Close();
                }
            }
        }

        /// <summary>The audio output's voice, which alone plays signals; null where it is not open.</summary>
        public HapticVoice? OnAudio => audio.OpenVoice;

        /// <summary>The audio output's voice; without one, the first device's that is open.</summary>
        public HapticVoice? Open
        {
            get
            {
                HapticVoice? open = OnAudio;
                for (int index = 0; open == null && index < devices.Length; ++index)
                {
                    open = devices[index].Voice.OpenVoice;
                }
                return open;
            }
        }

        public void Panic()
        {
            audio.Panic();
            foreach (Device each in devices)
            {
                each.Voice.Panic();
            }
        }

        /// <summary>Plays a clip on every voice that is open; null ends it.</summary>
        /// <returns>False without such a voice.</returns>
        public bool PlayClip(HapticClipFile? clip, float gain, bool loop)
        {
            bool plays = audio.PlayClip(clip, gain, loop);
            foreach (Device each in devices)
            {
                plays |= each.Voice.PlayClip(clip, gain, loop);
            }
            return plays;
        }

        public void Publish(in ContactReading reading, in ResolvedMaterial felt, HapticSession session)
        {
            audio.Publish(reading, felt, session, WantedAudio());
            foreach (Device each in devices)
            {
                each.Voice.Publish(reading, felt, session, each.Target);
            }
        }

        public void Close()
        {
            audio.Close();
            foreach (Device each in devices)
            {
                each.Voice.Close();
            }
        }

        /// <summary>Null for silence: a disabled output is not replaced by another.</summary>
        private HapticOutput? WantedAudio()
        {
            HapticOutput? chosen = stylus.Output;
            if (chosen == null)
            {
                return SceneOutputs.For(stylus);
            }
            AutoOutput.Retire(stylus);
            return chosen.isActiveAndEnabled ? chosen : null;
        }

        private sealed record Device(IVoiceTarget Target, StylusVoice Voice);
    }

    /// <summary>The voice of one stylus on one output: opens it when engine and output are available, reopens it when
    /// either changes, and publishes contact states to it. The voice that it leaves fades on its output. Main thread,
    /// no garbage while nothing changes.</summary>
    internal sealed class StylusVoice
    {
        private const double RetrySeconds = 0.5;

        private readonly HapticStylus stylus;
        private readonly MotionGate motion = new MotionGate();
        private ContactBody? movedOn;
        private HapticVoice? voice;
        private HapticEngine? engine;
        private IVoiceTarget? output;
        private float publishedStrength;
        private bool isTouching;

        // Why the last attempt to open a voice failed, what was asked for, and when to ask for the same again.
        private string? refusal;
        private (HapticEngine? Engine, IVoiceTarget? Output, int RateHz) refused;
        private double retrySeconds;

        // The output of which the console said last that the stylus left it during a touch.
        private IVoiceTarget? leftOutput;

        // The touch counter of the newest reading, whether or not a voice played it.
        private uint? newestTouch;

        // The landing that was over before the voice opened; null without one.
        private (uint Touch, uint Landings)? missedLanding;

        public StylusVoice(HapticStylus stylus) => this.stylus = stylus;

        /// <summary>The voice; null while there is none. A restart closes the engine with its voices, which the stylus
        /// detects in its next update.</summary>
        public HapticVoice? OpenVoice => ReferenceEquals(engine, HapticSession.Existing?.Engine) ? voice : null;

        public void Panic() => OpenVoice?.Panic();

        public bool PlayClip(HapticClipFile? clip, float gain, bool loop)
        {
            HapticVoice? open = OpenVoice;
            if (open == null)
            {
                return false;
            }
            if (clip != null && !isTouching)
            {
                // In the air the voice still has the strength of the surface that was touched last.
                SetStrength(stylus.Strength * output!.Strength);
            }
            return open.PlayClip(clip, gain, loop);
        }

        /// <summary>Publishes a contact state; opens the voice first where possible.</summary>
        /// <param name="felt">The material at the contact; without labels where there is none.</param>
        /// <param name="wanted">The output that plays the voice; null for silence.</param>
        public void Publish(
            in ContactReading reading, in ResolvedMaterial felt, HapticSession session, IVoiceTarget? wanted)
        {
            bool isReady = MakeReady(session, wanted, reading.State);
            newestTouch = reading.State.TouchCounter;
            if (!isReady)
            {
                return;
            }
            ContactState state = reading.State;
            bool isMissed = missedLanding == (state.TouchCounter, state.LandingCounter);
            state.ApproachSpeedMps = isMissed ? 0f : state.ApproachSpeedMps;
            // A material without a label that the model knows is silent, rather than played as another.
            state.Touching = felt.Labels.Count > 0;
            isTouching = state.Touching;
            if (state.Touching)
            {
                state.Material = felt.Labels;
                state.Effects = state.Relief == 0
                    ? felt.Effects
                    : (felt.Effects & ~HapticEffects.Nothing) | HapticEffects.Relief;
                state.SpatialScale = felt.FeatureScale;
                state.ToneDbPerOctave = felt.ToneDbPerOctave;
                state.Variation = felt.Variation;
                SetStrength(felt.Strength * stylus.Strength * output!.Strength);
            }
            bool moves = Moves(reading);
            if (output!.PlaysSignal)
            {
                state.FirstVelocityMps = moves ? (float)motion.SpeedMps : 0f;
                state.SecondVelocityMps = 0f;
            }
            voice!.Publish(state);
        }

        public void Close()
        {
            EndVoice();
            refusal = null;
        }

        private void EndVoice()
        {
            voice?.Dispose();
            voice = null;
            engine = null;
            output = null;
            isTouching = false;
        }

        private bool Moves(in ContactReading reading)
        {
            PlaceVector place = reading.State.PlaceMetres;
            var point = new Double3(place.X, place.Y, place.Z);
            if (!ReferenceEquals(movedOn, reading.Surface))
            {
                movedOn = reading.Surface;
                motion.Continue(reading.TimeSeconds, point);
            }
            return motion.Update(reading.TimeSeconds, reading.State.Touching, point);
        }

        private void SetStrength(float wanted)
        {
            if (!wanted.Equals(publishedStrength))
            {
                publishedStrength = wanted;
                voice!.SetStrength(wanted);
            }
        }

        private bool MakeReady(HapticSession session, IVoiceTarget? wanted, in ContactState tip)
        {
            if (voice != null && ReferenceEquals(engine, session.Engine) && ReferenceEquals(output, wanted))
            {
                return true;
            }
            bool isUnderWay = tip.Touching && (newestTouch ?? tip.TouchCounter) == tip.TouchCounter;
            if (isUnderWay && voice != null && !ReferenceEquals(output, wanted))
            {
                SayThatTheOutputChanged(wanted);
            }
            EndVoice();
            if (session.Engine == null || wanted == null || !MayOpen(session.Engine, wanted) || !Open(session, wanted))
            {
                return false;
            }
            missedLanding = isUnderWay ? (tip.TouchCounter, tip.LandingCounter) : ((uint, uint)?)null;
            return true;
        }

        /// <summary>False where the same was refused a moment ago. What kept it from being served may pass: another
        /// voice ends, a device returns.</summary>
        private bool MayOpen(HapticEngine asked, IVoiceTarget wanted) =>
            refusal == null || Time.unscaledTimeAsDouble >= retrySeconds ||
            refused != (asked, wanted, wanted.SampleRateHz);

        private bool Open(HapticSession session, IVoiceTarget wanted)
        {
            try
            {
                voice = session.Engine!.OpenVoice(wanted.SampleRateHz);
            }
            catch (HaptoFlowException refusing)
            {
                if (refusal != refusing.Message)
                {
                    Debug.LogError(
                        $"HaptoFlow: {stylus.PenName} gets no voice, and asks again: {refusing.Message}", stylus);
                }
                refusal = refusing.Message;
                refused = (session.Engine, wanted, wanted.SampleRateHz);
                retrySeconds = Time.unscaledTimeAsDouble + RetrySeconds;
                return false;
            }
            if (refusal != null)
            {
                refusal = null;
                Debug.Log($"HaptoFlow: {stylus.PenName} has got its voice.", stylus);
            }
            voice.SetCeiling(session.Settings.Ceiling);
            publishedStrength = stylus.Strength * wanted.Strength;
            voice.SetStrength(publishedStrength);
            engine = session.Engine;
            output = wanted;
            wanted.Add(voice);
            return true;
        }

        private void SayThatTheOutputChanged(IVoiceTarget? wanted)
        {
            if (!ReferenceEquals(leftOutput, output))
            {
                leftOutput = output;
                Debug.Log($"HaptoFlow: {stylus.PenName} lost {NameOf(output)} during a touch: its sound fades there, " +
                    "and " + (wanted == null
                        ? "it is silent until it has an output again."
                        : $"goes on on {NameOf(wanted)}."), stylus);
            }
        }

        private static string NameOf(IVoiceTarget? target) =>
            target is Object known && known != null ? known.name : "an output that is gone";
    }
}
