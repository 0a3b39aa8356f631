#nullable enable
using System;
using HaptoFlow.Preview;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Plays the recording or the result, and goes on with what takes its place. Main thread.</summary>
    internal sealed class NewMaterialPlayer
    {
        private readonly NewMaterialState state;
        private readonly NewMaterialSession session;
        private readonly PreviewSpeaker speaker = new PreviewSpeaker();
        private AnalysedSound? playing;
        private bool looped;
        private bool waits;

        public NewMaterialPlayer(NewMaterialState state, NewMaterialSession session)
        {
            this.state = state;
            this.session = session;
        }

        /// <summary>Null where nothing is there to be heard.</summary>
        public AnalysedSound? PlayedSound => session.Shown == null || session.Shown.Sounds.Count == 0
            ? null
            : session.Shown.Sounds[Math.Min(state.Active, session.Shown.Sounds.Count - 1)];

        public bool IsPlaying => speaker.IsPlaying;

        public bool IsAvailable => speaker.IsAvailable;

        /// <summary>Where the playhead is; null while nothing plays.</summary>
        public double? PlayedSeconds =>
            speaker.IsPlaying ? speaker.PositionSamples / (double)PreviewSound.RateHz : (double?)null;

        /// <summary>Both are raised by as much, until the louder one fills the speakers' range.</summary>
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

        /// <summary>Once an editor update.</summary>
        /// <returns>Something moves: the window is to be drawn again.</returns>
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
