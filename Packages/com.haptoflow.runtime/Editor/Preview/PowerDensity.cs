#nullable enable
using System;
using System.Numerics;

namespace HaptoFlow.Preview
{
    /// <summary>One-sided power spectral density of Hann windows of a waveform: 2 |X[k]|^2 / (rate sum w^2), in
    /// (m/s^2)^2/Hz. Its sum over all bins, multiplied by the width of a bin, is the mean square. One thread at a time.
    /// </summary>
    internal sealed class PowerDensity
    {
        private readonly Fourier fourier;
        private readonly double[] window;
        private readonly Complex[] values;
        private readonly double scale;

        /// <param name="length">Samples per window, a power of two.</param>
        public PowerDensity(int length, double rateHz)
        {
            fourier = new Fourier(length);
            window = new double[length];
            values = new Complex[length];
            double squares = 0.0;
            for (int index = 0; index < length; ++index)
            {
                window[index] = 0.5 - 0.5 * Math.Cos(2.0 * Math.PI * index / length);
                squares += window[index] * window[index];
            }
            scale = 2.0 / (rateHz * squares);
            HertzPerBin = rateHz / length;
        }

        public double HertzPerBin { get; }

        /// <summary>Computes the densities of a window. Samples outside the waveform count as zero.</summary>
        /// <param name="samples">In units of <see cref="PreviewSound.FullScaleMps2"/>.</param>
        /// <param name="begin">Index of the window's first sample; may be negative.</param>
        /// <param name="densities">Receives the bins from 0 Hz; its length is at most half the window.</param>
        public void Of(ReadOnlySpan<float> samples, int begin, Span<double> densities)
        {
            for (int index = 0; index < values.Length; ++index)
            {
                int place = begin + index;
                bool inside = place >= 0 && place < samples.Length;
                values[index] = inside ? window[index] * PreviewSound.FullScaleMps2 * samples[place] : 0.0;
            }
            fourier.Transform(values);
            for (int bin = 0; bin < densities.Length; ++bin)
            {
                double size = values[bin].Magnitude;
                densities[bin] = (bin == 0 ? 0.5 * scale : scale) * size * size;
            }
        }
    }

    /// <summary>Conversions to decibels.</summary>
    internal static class Levels
    {
        /// <summary>10 log10 of a power; minus infinity for zero.</summary>
        public static double Decibels(double power) =>
            power > 0.0 ? 10.0 * Math.Log10(power) : double.NegativeInfinity;

        /// <summary>Upper end of a level axis: the smallest multiple of ten at least 3 dB above the highest level.
        /// </summary>
        public static double Top(double highestDecibels) => double.IsInfinity(highestDecibels)
            ? 0.0
            : 10.0 * Math.Ceiling((highestDecibels + 3.0) / 10.0);
    }

    /// <summary>Discrete Fourier transform of a fixed length, X[k] = sum x[n] exp(-2 pi i k n / N), by the radix-2
    /// algorithm of Cooley and Tukey (1965).</summary>
    /// <remarks>Unity transforms only what an AudioSource plays, and a package cannot depend on NuGet.</remarks>
    internal sealed class Fourier
    {
        private readonly Complex[] turns;

        /// <param name="length">A power of two.</param>
        public Fourier(int length)
        {
            turns = new Complex[length / 2];
            for (int index = 0; index < turns.Length; ++index)
            {
                turns[index] = Complex.FromPolarCoordinates(1.0, -Math.PI * index / turns.Length);
            }
        }

        /// <summary>Transforms in place.</summary>
        public void Transform(Complex[] values)
        {
            for (int index = 1, mirrored = 0; index < values.Length; ++index)
            {
                int bit = values.Length >> 1;
                for (; (mirrored & bit) != 0; bit >>= 1)
                {
                    mirrored ^= bit;
                }
                mirrored ^= bit;
                if (index < mirrored)
                {
                    (values[index], values[mirrored]) = (values[mirrored], values[index]);
                }
            }
            for (int half = 1; half < values.Length; half *= 2)
            {
                for (int begin = 0; begin < values.Length; begin += 2 * half)
                {
                    for (int upper = begin; upper < begin + half; ++upper)
                    {
                        Complex turned = turns[(upper - begin) * (turns.Length / half)] * values[upper + half];
                        values[upper + half] = values[upper] - turned;
                        values[upper] += turned;
                    }
                }
            }
        }
    }
}
