#nullable enable
using System;
using HaptoFlow.Preview;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Plays the recording or the result, and continues with its replacement at the same position. Main
    /// thread.</summary>
    internal sealed class NewMaterialPlayer
    {
        private readonly NewMaterialState state;
        private readonly NewMaterialSession session;
        private readonly PreviewSpeaker speaker = new PreviewSpeaker();
        private AnalysedSound? playing;
        private bool looped;
        private bool waits;

        public NewMaterialPlayer(NewMaterialState state, NewMaterialSession session) =>
            (this.state, this.session) = (state, session);

        /// <summary>The chosen sound; null if there is none.</summary>
        public AnalysedSound? PlayedSound => session.Shown == null || session.Shown.Sounds.Count == 0
            ? null
            : session.Shown.Sounds[Math.Min(state.Active, session.Shown.Sounds.Count - 1)];

        public bool IsPlaying => speaker.IsPlaying;

        public bool IsAvailable => speaker.IsAvailable;

        /// <summary>Position of playback; null while nothing plays.</summary>
        public double? PlayedSeconds =>
            speaker.IsPlaying ? speaker.PositionSamples / (double)PreviewSound.RateHz : (double?)null;

        /// <summary>Gain of both sounds, at which the louder one nearly reaches full scale.</summary>
        public float Gain
        {
            get
            {
                float peak = 1e-6f;
                if (session.Shown != null)
                {
                    foreach (AnalysedSound sound in session.Shown.Sounds)
                    {
                        peak = Mathf.Max(peak, sound.Sound.Peak);
                    }
                }
                return PreviewPlayer.RaisedPeak / peak;
            }
        }

        public void Toggle()
        {
            waits = !speaker.IsPlaying;
            if (speaker.IsPlaying)
            {
                Stop();
            }
        }

        public void Stop()
        {
            waits = false;
            playing = null;
            speaker.Stop();
        }

        /// <summary>Call this at each editor update.</summary>
        /// <returns>True if the window must be drawn again.</returns>
        public bool Step()
        {
            bool wasPlaying = speaker.IsPlaying;
            if (waits && !session.IsBusy && PlayedSound != null)
            {
                waits = false;
                Start(0);
            }
            else if (wasPlaying && !session.IsBusy && PlayedSound != null &&
                (!ReferenceEquals(PlayedSound, playing) || looped != state.Loops))
            {
                Start(speaker.PositionSamples);
            }
            else if (playing != null && !wasPlaying)
            {
                Stop();
            }
            return wasPlaying || speaker.IsPlaying;
        }

        private void Start(int sample)
        {
            playing = PlayedSound;
            looped = state.Loops;
            speaker.Play(playing!.Sound, Gain, sample, looped);
        }
    }
}
