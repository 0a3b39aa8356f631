#nullable enable
using System;
using System.Threading;

namespace HaptoFlow.Preview
{
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
            var first = new double[rows];
            var second = new double[rows];
            for (int column = 0; column < columns; column += 2)
            {
                token.ThrowIfCancellationRequested();
                density.Of(sound.Samples, Begin(sound, column, columns), Begin(sound, column + 1, columns), first,
                    second);
                result.Store(column, first);
                result.Store(column + 1, second);
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
}
