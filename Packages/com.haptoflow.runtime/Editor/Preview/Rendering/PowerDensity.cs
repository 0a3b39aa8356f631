#nullable enable
using System;

namespace HaptoFlow.Preview
{
    /// <summary>One-sided power spectral density of Hann windows of a waveform: 2 |X[k]|^2 / (rate sum w^2), in
    /// (m/s^2)^2/Hz. Its sum over all bins, multiplied by the width of a bin, is the mean square.</summary>
    internal sealed class PowerDensity
    {
        private readonly Fourier fourier;
        private readonly double[] window;
        private readonly double[] real;
        private readonly double[] imaginary;
        private readonly double scale;

        /// <param name="length">Samples per window, a power of two.</param>
        public PowerDensity(int length, double rateHz)
        {
            fourier = new Fourier(length);
            window = new double[length];
            real = new double[length];
            imaginary = new double[length];
            double squares = 0.0;
            for (int index = 0; index < length; ++index)
            {
                window[index] = 0.5 - 0.5 * Math.Cos(2.0 * Math.PI * index / length);
                squares += window[index] * window[index];
            }
            scale = 2.0 / (rateHz * squares);
            HertzPerBin = rateHz / length;
        }

        public int Length => fourier.Length;

        public double HertzPerBin { get; }

        /// <summary>Computes the densities of two windows in one transform, as real and imaginary part of its input.
        /// Samples outside the waveform count as zero.</summary>
        /// <param name="samples">In units of <see cref="PreviewSound.FullScaleMps2"/>.</param>
        /// <param name="first">Index of the first window's first sample; may be negative.</param>
        /// <param name="second">Index of the second window's first sample; may be negative.</param>
        /// <param name="firstDensities">Receives the bins from 0 Hz; its length is at most half the window.</param>
        /// <param name="secondDensities">As long as <paramref name="firstDensities"/>.</param>
        public void Of(ReadOnlySpan<float> samples, int first, int second, Span<double> firstDensities,
            Span<double> secondDensities)
        {
            Load(samples, first, real);
            Load(samples, second, imaginary);
            fourier.Transform(real, imaginary);
            for (int bin = 0; bin < firstDensities.Length; ++bin)
            {
                int mirrored = (Length - bin) & (Length - 1);
                double sumReal = 0.5 * (real[bin] + real[mirrored]);
                double sumImaginary = 0.5 * (imaginary[bin] - imaginary[mirrored]);
                double differenceReal = 0.5 * (imaginary[bin] + imaginary[mirrored]);
                double differenceImaginary = 0.5 * (real[mirrored] - real[bin]);
                double one = bin == 0 ? 0.5 * scale : scale;
                firstDensities[bin] = one * (sumReal * sumReal + sumImaginary * sumImaginary);
                secondDensities[bin] =
                    one * (differenceReal * differenceReal + differenceImaginary * differenceImaginary);
            }
        }

        private void Load(ReadOnlySpan<float> samples, int begin, double[] into)
        {
            for (int index = 0; index < into.Length; ++index)
            {
                int place = begin + index;
                bool inside = place >= 0 && place < samples.Length;
                into[index] = inside ? window[index] * PreviewSound.FullScaleMps2 * samples[place] : 0.0;
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
    /// algorithm of Cooley and Tukey (1965). One thread at a time.</summary>
    /// <remarks>Unity transforms only what an AudioSource plays, and a package cannot depend on NuGet.</remarks>
    internal sealed class Fourier
    {
        private readonly double[] cosines;
        private readonly double[] sines;
        private readonly int[] reversed;

        /// <param name="length">A power of two.</param>
        public Fourier(int length)
        {
            Length = length;
            cosines = new double[length / 2];
            sines = new double[length / 2];
            for (int index = 0; index < length / 2; ++index)
            {
                cosines[index] = Math.Cos(2.0 * Math.PI * index / length);
                sines[index] = -Math.Sin(2.0 * Math.PI * index / length);
            }
            reversed = new int[length];
            for (int index = 1; index < length; ++index)
            {
                reversed[index] = (reversed[index >> 1] >> 1) | ((index & 1) != 0 ? length >> 1 : 0);
            }
        }

        public int Length { get; }

        public void Transform(double[] real, double[] imaginary)
        {
            for (int index = 0; index < Length; ++index)
            {
                int other = reversed[index];
                if (other > index)
                {
                    (real[index], real[other]) = (real[other], real[index]);
                    (imaginary[index], imaginary[other]) = (imaginary[other], imaginary[index]);
                }
            }
            for (int half = 1; half < Length; half *= 2)
            {
                int stride = Length / (2 * half);
                for (int begin = 0; begin < Length; begin += 2 * half)
                {
                    Butterflies(real, imaginary, begin, half, stride);
                }
            }
        }

        private void Butterflies(double[] real, double[] imaginary, int begin, int half, int stride)
        {
            for (int index = 0; index < half; ++index)
            {
                int upper = begin + index;
                int lower = upper + half;
                double cosine = cosines[index * stride];
                double sine = sines[index * stride];
                double turnedReal = real[lower] * cosine - imaginary[lower] * sine;
                double turnedImaginary = real[lower] * sine + imaginary[lower] * cosine;
                real[lower] = real[upper] - turnedReal;
                imaginary[lower] = imaginary[upper] - turnedImaginary;
                real[upper] += turnedReal;
                imaginary[upper] += turnedImaginary;
            }
        }
    }
}
