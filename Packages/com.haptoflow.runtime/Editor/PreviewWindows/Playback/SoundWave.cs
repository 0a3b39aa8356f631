#nullable enable
using System;
using HaptoFlow.Outputs;
using HaptoFlow.Preview;
using HaptoFlow.Recordings;

namespace HaptoFlow.Editor
{
    /// <summary>A sound as the wave of a device's queue, at the queue's rate. Main thread.</summary>
    internal sealed class SoundWave : IWaveSource
    {
        // The speakers report their position in steps of a block, some 20 ms.
        private const int ToleratedSamples = PreviewSound.RateHz / 20;
        private const int Step = (int)(PreviewSound.RateHz / WaveHistory.RateHz);

        private PreviewSound? sound;

        // At the queue's rate; made when a device first asks for it.
        private float[]? wave;
        private bool loops;

        /// <summary>Position in the sound at its own rate.</summary>
        public int PositionSamples { get; private set; }

        /// <inheritdoc/>
        public bool IsStopped => sound == null;

        /// <summary>Plays a sound in place of the present one.</summary>
        /// <param name="startSample">Start position; a position past the end counts as 0.</param>
        public void Play(PreviewSound next, int startSample, bool repeats)
        {
            sound = next.Samples.Length > 0 ? next : null;
            wave = null;
            loops = repeats;
            PositionSamples = startSample < next.Samples.Length ? startSample : 0;
        }

        public void Stop()
        {
            sound = null;
            PositionSamples = 0;
        }

        /// <summary>Continues at another position of the sound if the present one is far from it.</summary>
        public void Follow(int sample)
        {
            if (sound == null)
            {
                return;
            }
            int apart = Math.Abs(sample - PositionSamples);
            int shortest = loops ? Math.Min(apart, sound.Samples.Length - apart) : apart;
            if (shortest > ToleratedSamples && sample < sound.Samples.Length)
            {
                PositionSamples = sample;
            }
        }

        /// <inheritdoc/>
        public void Render(Span<float> samples)
        {
            for (int index = 0; index < samples.Length; ++index)
            {
                samples[index] = sound != null ? Next(sound) : 0f;
            }
        }

        private float Next(PreviewSound playing)
        {
            wave ??= Waves.Resampled(playing.Samples, PreviewSound.RateHz, WaveHistory.RateHz);
            float sample = wave[Math.Min(PositionSamples / Step, wave.Length - 1)];
            PositionSamples += Step;
            if (PositionSamples >= playing.Samples.Length)
            {
                PositionSamples = loops ? PositionSamples - playing.Samples.Length : 0;
                sound = loops ? sound : null;
            }
            return sample;
        }
    }
}
