#nullable enable
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Preview;

namespace HaptoFlow.Editor
{
    /// <summary>Plays the chosen one of the sounds of a window, and continues with its replacement at the same
    /// position. Main thread.</summary>
    internal abstract class SoundPlayer
    {
        /// <summary>Peak of the louder sound after normalising.</summary>
        public const float RaisedPeak = 0.9f;

        private AnalysedSound? playing;
        private (bool Raises, bool Loops) mode;
        private bool waits;
        private bool wasPlaying;

        /// <summary>The chosen sound; null if there is none.</summary>
        public AnalysedSound? PlayedSound => Index < Sounds.Count ? Sounds[Index] : null;

        public virtual bool IsPlaying => Speaker.IsPlaying;

        /// <summary>Position of playback; null while nothing plays.</summary>
        public double? PlayedSeconds => IsPlaying ? PositionSamples / (double)PreviewSound.RateHz : (double?)null;

        /// <summary>Gain of all sounds.</summary>
        public abstract float Gain { get; }

        protected PreviewSpeaker Speaker { get; } = new PreviewSpeaker();

        /// <summary>The sounds that are shown; none until they are rendered.</summary>
        protected abstract IReadOnlyList<AnalysedSound> Sounds { get; }

        /// <summary>Index of the chosen sound.</summary>
        protected abstract int Index { get; }

        /// <summary>Whether playback is normalised, and whether it is repeated.</summary>
        protected abstract (bool Raises, bool Loops) Mode { get; }

        /// <summary>True if the sounds belong to the present settings.</summary>
        protected abstract bool IsFinal { get; }

        protected virtual int PositionSamples => Speaker.PositionSamples;

        protected float Peak => Sounds.Select(each => each.Sound.Peak).DefaultIfEmpty().Max();

        /// <summary>Plays from the beginning, or stops.</summary>
        public void Toggle()
        {
            if (IsPlaying)
            {
                Stop();
            }
            else
            {
                PlayWhenReady();
            }
        }

        /// <summary>Plays as soon as the present settings are rendered.</summary>
        public void PlayWhenReady() => waits = true;

        public virtual void Stop()
        {
            waits = false;
            playing = null;
            Speaker.Stop();
        }

        /// <summary>Call this at each editor update.</summary>
        /// <returns>True if the window must be drawn again.</returns>
        public virtual bool Step()
        {
            AnalysedSound? sound = IsFinal ? PlayedSound : null;
            if (waits && sound != null)
            {
                waits = false;
                Start(sound, 0);
            }
            else if (IsPlaying && sound != null && (!ReferenceEquals(sound, playing) || mode != Mode))
            {
                Start(sound, PositionSamples);
            }
            else if (playing != null && !IsPlaying)
            {
                Stop();
            }
            bool moved = wasPlaying || IsPlaying;
            wasPlaying = IsPlaying;
            return moved;
        }

        protected virtual void Start(AnalysedSound sound, int sample)
        {
            playing = sound;
            mode = Mode;
            Speaker.Play(sound.Sound, Gain, sample, mode.Loops);
        }
    }
}
