#nullable enable
using System;

namespace HaptoFlow.Outputs
{
    /// <summary>What a stretch of the wave feels like.</summary>
    public readonly struct WaveFrame
    {
        /// <param name="amplitude">See <see cref="Amplitude"/>.</param>
        /// <param name="frequencyHz">See <see cref="FrequencyHz"/>.</param>
        /// <param name="transient">See <see cref="Transient"/>.</param>
        public WaveFrame(float amplitude, float frequencyHz, float transient)
        {
            Amplitude = amplitude;
            FrequencyHz = frequencyHz;
            Transient = transient;
        }

        /// <summary>Of the vibration that feels as strong, 0 to 1.</summary>
        public float Amplitude { get; }

        /// <summary>Where the energy is, in Hz; 0 for silence.</summary>
        public float FrequencyHz { get; }

        /// <summary>Amplitude of a knock within the stretch, 0 to 1; 0 for none.</summary>
        public float Transient { get; }
    }

    /// <summary>Makes frames of amplitude, frequency and transients from a wave at <see cref="WaveHistory.RateHz"/>.
    /// Without garbage; main thread.</summary>
    public interface IWaveFeatures
    {
        /// <summary>Forgets what came before: the wave begins anew.</summary>
        void Reset();

        /// <summary>One frame for one stretch, which follows the last one.</summary>
        WaveFrame Analyse(ReadOnlySpan<float> samples);
    }

    /// <summary>Level features, computed here: the amplitude of the sine of equal RMS, the frequency from the energy of
    /// the wave's slope, a transient where the amplitude doubles. It knows nothing of what the skin feels at which
    /// frequency.</summary>
    public sealed class RmsWaveFeatures : IWaveFeatures
    {
        private const float LeastAmplitude = 0.001f;
        private const float LeastTransient = 0.05f;
        private const float Jump = 2f;

        private float previousSample;
        private float previousAmplitude;

        /// <inheritdoc/>
        public void Reset()
        {
            previousSample = 0f;
            previousAmplitude = 0f;
        }

        /// <inheritdoc/>
        public WaveFrame Analyse(ReadOnlySpan<float> samples)
        {
            if (samples.Length == 0)
            {
                return default;
            }
            double energy = 0.0;
            double slopeEnergy = 0.0;
            foreach (float sample in samples)
            {
                double slope = sample - previousSample;
                energy += (double)sample * sample;
                slopeEnergy += slope * slope;
                previousSample = sample;
            }
            float amplitude = (float)Math.Min(1.0, Math.Sqrt(2.0 * energy / samples.Length));
            if (amplitude < LeastAmplitude)
            {
                previousAmplitude = 0f;
                return default;
            }
            bool jumps = amplitude > Jump * previousAmplitude && amplitude - previousAmplitude > LeastTransient;
            float transient = jumps ? amplitude - previousAmplitude : 0f;
            previousAmplitude = amplitude;
            // A sine's difference from sample to sample is 2 sin(pi f / rate) of its amplitude.
            double half = Math.Min(1.0, 0.5 * Math.Sqrt(slopeEnergy / energy));
            return new WaveFrame(amplitude, (float)(Math.Asin(half) * WaveHistory.RateHz / Math.PI), transient);
        }
    }
}
