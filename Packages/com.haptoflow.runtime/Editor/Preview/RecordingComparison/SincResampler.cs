#nullable enable
using System;

namespace HaptoFlow.Preview
{
    /// <summary>Resamples with a Hann-windowed sinc (Smith and Gossett 1984), band-limited to the lower of the two
    /// Nyquist frequencies.</summary>
    /// <remarks>Unity resamples only audio files, when it imports them.</remarks>
    internal static class SincResampler
    {
        // Zero crossings of the sinc on either side.
        private const int Lobes = 16;

        public static float[] Resampled(ReadOnlySpan<float> samples, double fromHz, double toHz)
        {
            var result = new float[(int)Math.Floor(samples.Length * toHz / fromHz + 1e-9)];
            double cutoff = Math.Min(1.0, toHz / fromHz);
            double half = Lobes / cutoff;
            for (int index = 0; index < result.Length; ++index)
            {
                double place = index * fromHz / toHz;
                int first = Math.Max(0, (int)Math.Ceiling(place - half));
                int last = Math.Min(samples.Length - 1, (int)Math.Floor(place + half));
                double sum = 0.0;
                for (int input = first; input <= last; ++input)
                {
                    sum += samples[input] * Weight(input - place, cutoff);
                }
                result[index] = (float)sum;
            }
            return result;
        }

        /// <summary>The weights with which every sample of a rate that is a whole number of times lower is computed from
        /// the samples around it.</summary>
        public static float[] Kernel(int timesLower)
        {
            int half = Lobes * timesLower;
            var weights = new float[2 * half + 1];
            for (int index = 0; index < weights.Length; ++index)
            {
                weights[index] = (float)Weight(index - half, 1.0 / timesLower);
            }
            return weights;
        }

        private static double Weight(double distance, double cutoff)
        {
            double window = 0.5 + 0.5 * Math.Cos(Math.PI * distance * cutoff / Lobes);
            return window * cutoff * Sinc(cutoff * distance);
        }

        private static double Sinc(double place) =>
            Math.Abs(place) < 1e-9 ? 1.0 : Math.Sin(Math.PI * place) / (Math.PI * place);
    }
}
