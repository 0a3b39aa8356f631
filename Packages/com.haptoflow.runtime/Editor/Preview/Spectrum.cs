#nullable enable
using System;
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

        /// <exception cref="OperationCanceledException">The token was cancelled.</exception>
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

        /// <exception cref="OperationCanceledException">The token was cancelled.</exception>
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
        /// <exception cref="System.OperationCanceledException">The token was cancelled.</exception>
        public static AnalysedSound Of(PreviewSound sound, CancellationToken token) =>
            new AnalysedSound(sound, Spectrum.Of(sound, token), Spectrogram.Of(sound, token));
    }
}
