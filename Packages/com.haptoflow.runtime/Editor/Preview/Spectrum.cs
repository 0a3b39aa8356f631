#nullable enable
using System;
using System.Numerics;
using System.Threading;

namespace HaptoFlow.Preview
{
    /// <summary>Mean power spectral density of a sound while its tip touches, by the method of Welch (1967) with Hann
    /// windows of 171 ms that overlap by half. Immutable.</summary>
    internal sealed class Spectrum
    {
        public const double MinimumHz = 20.0;
        public const double MaximumHz = 1000.0;

        private const int WindowSamples = 8192;

        private readonly double[] densities;

        private Spectrum(double[] densities, double hertzPerBin) =>
            (this.densities, HertzPerBin) = (densities, hertzPerBin);

        public double HertzPerBin { get; }

        /// <summary>Number of frequencies from 0 Hz to past <see cref="MaximumHz"/>.</summary>
        public int Bins => densities.Length;

        public static Spectrum Of(PreviewSound sound, CancellationToken token)
        {
            var density = new PowerDensity(WindowSamples, PreviewSound.RateHz);
            var sum = new double[(int)(MaximumHz / density.HertzPerBin) + 2];
            var densities = new double[sum.Length];
            int windows = 0;
            for (int begin = 0; begin < sound.Samples.Length; begin += WindowSamples / 2)
            {
                token.ThrowIfCancellationRequested();
                if (!IsTouched(sound, begin))
                {
                    continue;
                }
                density.Of(sound.Samples, begin, densities);
                ++windows;
                for (int bin = 0; bin < sum.Length; ++bin)
                {
                    sum[bin] += densities[bin];
                }
            }
            for (int bin = 0; bin < sum.Length; ++bin)
            {
                sum[bin] /= Math.Max(1, windows);
            }
            return new Spectrum(sum, density.HertzPerBin);
        }

        /// <summary>Level at a frequency, dB re 1 (m/s^2)^2/Hz; the density is interpolated linearly between bins.
        /// Minus infinity for silence.</summary>
        public double Decibels(double hertz)
        {
            double place = Math.Max(0.0, Math.Min(Bins - 1.0, hertz / HertzPerBin));
            int bin = Math.Min(Bins - 2, (int)place);
            return Levels.Decibels(densities[bin] + (place - bin) * (densities[bin + 1] - densities[bin]));
        }

        /// <summary>The highest level within a band, both ends included.</summary>
        public double DecibelsBetween(double fromHertz, double toHertz)
        {
            double highest = Math.Max(Decibels(fromHertz), Decibels(toHertz));
            int last = Math.Min(Bins - 1, (int)Math.Floor(toHertz / HertzPerBin));
            for (int bin = (int)Math.Ceiling(fromHertz / HertzPerBin); bin <= last; ++bin)
            {
                highest = Math.Max(highest, Levels.Decibels(densities[bin]));
            }
            return highest;
        }

        private static bool IsTouched(PreviewSound sound, int begin)
        {
            double middle = (begin + WindowSamples / 2) / (double)PreviewSound.RateHz;
            return middle < sound.DurationSeconds && sound.Stroke.At(middle).Touching;
        }
    }

    /// <summary>Power spectral density over time, from Hann windows of 85 ms at a hop of 10 ms. Immutable.</summary>
    internal sealed class Spectrogram
    {
        private const int WindowSamples = 4096;
        private const double ColumnsPerSecond = 100.0;

        private readonly float[] decibels;

        private Spectrogram(float[] decibels, int columns, int rows, double hertzPerRow) =>
            (this.decibels, Columns, Rows, HertzPerRow) = (decibels, columns, rows, hertzPerRow);

        /// <summary>Number of windows, spread evenly over the sound's length.</summary>
        public int Columns { get; }

        /// <summary>Number of frequencies from 0 Hz to past <see cref="Spectrum.MaximumHz"/>.</summary>
        public int Rows { get; }

        public double HertzPerRow { get; }

        /// <summary>Highest level of all, dB re 1 (m/s^2)^2/Hz; minus infinity for silence.</summary>
        public float Highest { get; private set; } = float.NegativeInfinity;

        public static Spectrogram Of(PreviewSound sound, CancellationToken token)
        {
            var density = new PowerDensity(WindowSamples, PreviewSound.RateHz);
            int rows = (int)(Spectrum.MaximumHz / density.HertzPerBin) + 2;
            int columns = Math.Max(2, 2 * (int)Math.Round(0.5 * sound.DurationSeconds * ColumnsPerSecond));
            var result = new Spectrogram(new float[columns * rows], columns, rows, density.HertzPerBin);
            var densities = new double[rows];
            for (int column = 0; column < columns; ++column)
            {
                token.ThrowIfCancellationRequested();
                density.Of(sound.Samples, Begin(sound, column, columns), densities);
                result.Store(column, densities);
            }
            return result;
        }

        /// <summary>dB re 1 (m/s^2)^2/Hz.</summary>
        public float Decibels(int column, int row) => decibels[column * Rows + row];

        private static int Begin(PreviewSound sound, int column, int columns) =>
            (int)((column + 0.5) * sound.Samples.Length / columns) - WindowSamples / 2;

        private void Store(int column, double[] densities)
        {
            for (int row = 0; row < Rows; ++row)
            {
                var value = (float)Levels.Decibels(densities[row]);
                decibels[column * Rows + row] = value;
                Highest = Math.Max(Highest, value);
            }
        }
    }

    /// <summary>A sound with its spectrum and its spectrogram. Immutable.</summary>
    internal sealed record AnalysedSound(PreviewSound Sound, Spectrum Spectrum, Spectrogram Spectrogram)
    {
        public static AnalysedSound Of(PreviewSound sound, CancellationToken token) =>
            new AnalysedSound(sound, Spectrum.Of(sound, token), Spectrogram.Of(sound, token));
    }

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
