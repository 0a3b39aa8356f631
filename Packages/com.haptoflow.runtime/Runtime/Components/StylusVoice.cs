#nullable enable
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>The voice of one stylus on one output: opens it when engine and output are available, reopens it when
    /// either changes, and publishes contact states to it. Main thread, no garbage while nothing changes.</summary>
    internal sealed class StylusVoice
    {
        private readonly HapticStylus stylus;
        private readonly MotionGate motion = new MotionGate();
        private ContactBody? movedOn;
        private HapticVoice? voice;
        private HapticEngine? engine;
        private HapticEngine? refusedBy;
        private IVoiceTarget? output;
        private float publishedStrength;

        // A voice of the previous engine: it fades out while the present one begins.
        private readonly FadingVoice leaving = new FadingVoice();

        // The touch counter of the newest reading, whether or not a voice played it.
        private uint? newestTouch;

        // The landing that was over before the voice opened; null without one.
        private (uint Touch, uint Landings)? missedLanding;

        public StylusVoice(HapticStylus stylus) => this.stylus = stylus;

        // A restart closes the engine with its voices; the stylus detects it in its next update.
        private bool IsOpen => voice != null && ReferenceEquals(engine, HapticSession.Existing?.Engine);

        public bool TryGetStatistics(out VoiceStatistics statistics)
        {
            statistics = IsOpen ? voice!.Statistics() : default;
            return IsOpen;
        }

        public bool TryGetEffectStatistics(HapticEffect effect, out EffectStatistics statistics)
        {
            statistics = IsOpen ? voice!.EffectStatistics(effect) : default;
            return IsOpen;
        }

        public bool TryGetSignalStatistics(out SignalStatistics statistics)
        {
            statistics = IsOpen ? voice!.SignalStatistics() : default;
            return IsOpen;
        }

        public void Panic()
        {
            if (IsOpen)
            {
                voice!.Panic();
            }
        }

        /// <summary>Publishes a contact state; opens the voice first where possible.</summary>
        /// <param name="felt">The material at the contact; without labels where there is none.</param>
        /// <param name="wanted">The output that plays the voice; null for silence.</param>
        public void Publish(
            in ContactReading reading, in ResolvedMaterial felt, HapticSession session, IVoiceTarget? wanted)
        {
            leaving.Update();
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
            if (state.Touching)
            {
                state.Material = felt.Labels;
                state.Effects = felt.Effects;
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
            leaving.Close();
            if (voice == null)
            {
                return;
            }
            output!.Remove(voice);
            voice.Dispose();
            voice = null;
            engine = null;
            output = null;
        }

        /// <summary>Whether the tip moves over what it touches, in its frame.</summary>
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
            if (session.Engine == null)
            {
                Close();
                return false;
            }
            if (wanted == null)
            {
                Close();
                return false;
            }
            if (voice != null && ReferenceEquals(engine, session.Engine) && ReferenceEquals(output, wanted))
            {
                return true;
            }
            if (voice != null && ReferenceEquals(output, wanted))
            {
                leaving.Take(voice, wanted);
                voice = null;
            }
            else
            {
                Close();
            }
            if (ReferenceEquals(refusedBy, session.Engine) || !Open(session, wanted))
            {
                return false;
            }
            bool isUnderWay = tip.Touching && (newestTouch ?? tip.TouchCounter) == tip.TouchCounter;
            missedLanding = isUnderWay ? (tip.TouchCounter, tip.LandingCounter) : ((uint, uint)?)null;
            return true;
        }

        private bool Open(HapticSession session, IVoiceTarget wanted)
        {
            try
            {
                voice = session.Engine!.OpenVoice(wanted.SampleRateHz);
            }
            catch (HaptoFlowException refusal)
            {
                refusedBy = session.Engine;
                Debug.LogError($"HaptoFlow: {stylus.name} gets no voice: {refusal.Message}", stylus);
                return false;
            }
            voice.SetCeiling(session.Settings.Ceiling);
            publishedStrength = stylus.Strength * wanted.Strength;
            voice.SetStrength(publishedStrength);
            engine = session.Engine;
            output = wanted;
            wanted.Add(voice);
            return true;
        }
    }
}
