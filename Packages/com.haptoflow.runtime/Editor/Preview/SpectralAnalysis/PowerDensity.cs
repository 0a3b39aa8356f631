#nullable enable
using System;

namespace HaptoFlow.Preview
{
    /// <summary>One-sided power spectral density of Hann windows of a wave: 2 |X[k]|^2 / (rate sum w^2), in
    /// (m/s^2)^2/Hz. Summed over all bins and multiplied by their width it is the mean square.</summary>
    internal sealed class PowerDensity
    {
        private readonly Fourier fourier;
        private readonly double[] window;
        private readonly double[] real;
        private readonly double[] imaginary;
        private readonly double scale;

        /// <param name="length">Samples of a window, a power of two.</param>
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

        /// <summary>Densities of two windows of a wave at once: a real wave in each part of a complex one. Outside the
        /// wave there is silence.</summary>
        /// <param name="samples">+-1 of <see cref="PreviewSound.FullScaleMps2"/>.</param>
        /// <param name="first">Where the first window begins, also before 0.</param>
        /// <param name="firstDensities">As many bins from 0 Hz on as it has room for, at most half the length.</param>
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

    /// <summary>Arithmetic of decibels.</summary>
    internal static class Levels
    {
        /// <summary>10 log10 of a power; minus infinity for none.</summary>
        public static double Decibels(double power) =>
            power > 0.0 ? 10.0 * Math.Log10(power) : double.NegativeInfinity;

        /// <summary>The next multiple of ten that is at least 3 dB above: the top of a picture.</summary>
        public static double Top(double highestDecibels) => double.IsInfinity(highestDecibels)
            ? 0.0
            : 10.0 * Math.Ceiling((highestDecibels + 3.0) / 10.0);
    }
}
