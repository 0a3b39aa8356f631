#nullable enable
using System;

namespace HaptoFlow.Studies
{
    /// <summary>Noise with a root mean square of 1. System.Random is slower and allocates its state table. One thread
    /// at a time; no garbage.</summary>
    internal sealed class NoiseGenerator
    {
        // Uniform numbers of +-1 have a root mean square of 1 / sqrt(3).
        private const float WhiteScale = 1.7320508f;

        // Normalises the filter's output for white noise with a root mean square of 1, from its impulse response.
        private static readonly float PinkScale;

        private readonly float[] state = new float[7];
        private uint bits = 0x9E3779B9u;

        // An explicit static constructor runs when the first generator is created, not on the audio thread.
        static NoiseGenerator() => PinkScale = FindPinkScale();

        public float Next(bool isPink)
        {
            // Marsaglia (2003), Xorshift RNGs.
            bits ^= bits << 13;
            bits ^= bits >> 17;
            bits ^= bits << 5;
            float white = WhiteScale * (bits * (2f / 4294967296f) - 1f);
            return isPink ? PinkScale * Filtered(state, white) : white;
        }

        /// <summary>Paul Kellet's filter (1999): within 0.1 dB of -3 dB per octave above 9 Hz at 44.1 kHz.</summary>
        private static float Filtered(float[] state, float white)
        {
            state[0] = 0.99886f * state[0] + white * 0.0555179f;
            state[1] = 0.99332f * state[1] + white * 0.0750759f;
            state[2] = 0.96900f * state[2] + white * 0.1538520f;
            state[3] = 0.86650f * state[3] + white * 0.3104856f;
            state[4] = 0.55000f * state[4] + white * 0.5329522f;
            state[5] = -0.7616f * state[5] - white * 0.0168980f;
            float pink = state[0] + state[1] + state[2] + state[3] + state[4] + state[5] + state[6] + white * 0.5362f;
            state[6] = white * 0.115926f;
            return pink;
        }

        private static float FindPinkScale()
        {
            var quiet = new float[7];
            double energy = 0.0;
            for (int sample = 0; sample < 20000; ++sample)
            {
                double response = Filtered(quiet, sample == 0 ? 1f : 0f);
                energy += response * response;
            }
            return (float)(1.0 / Math.Sqrt(energy));
        }
    }
}
