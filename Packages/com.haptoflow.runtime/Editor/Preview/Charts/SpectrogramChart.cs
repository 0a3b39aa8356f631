#nullable enable
using System;
using System.Linq;

namespace HaptoFlow.Preview
{
    /// <summary>Power spectral density over time and frequency, in colours.</summary>
    internal static class SpectrogramChart
    {
        /// <summary>Between black and the brightest colour.</summary>
        public const double RangeDecibels = 60.0;

        private static readonly double[] RowsHz = { 0.0, 250.0, 500.0, 750.0, 1000.0 };

        /// <param name="frame">The plot itself; scales are drawn left of it and below.</param>
        /// <param name="topDecibels">Of the brightest colour, dB re 1 (m/s^2)^2/Hz.</param>
        public static void Draw(PixelCanvas canvas, Palette palette, Box frame, Spectrogram spectrogram,
            double durationSeconds, double topDecibels)
        {
            var plot = new Plot(
                canvas, palette, frame, (0.0, durationSeconds), (0.0, Spectrum.HighestHz));
            foreach (double hertz in RowsHz)
            {
                plot.RowText(Scale.Text(hertz, 0), plot.Y(hertz), frame.Left - 6.0, TextAlign.Right, palette.Soft);
            }
            plot.ColumnTexts(Scale.Ticks(0.0, durationSeconds, 6), value => Scale.Text(value, 2), "s");
            var left = (int)Math.Round(plot.Frame.Left * canvas.Scale);
            var top = (int)Math.Round(plot.Frame.Top * canvas.Scale);
            var width = (int)Math.Round(plot.Frame.Width * canvas.Scale);
            var height = (int)Math.Round(plot.Frame.Height * canvas.Scale);
            float[] shares = Shares(spectrogram, topDecibels);
            for (int y = 0; y < height; ++y)
            {
                (int low, float up) = Place(
                    (1.0 - (y + 0.5) / height) * Spectrum.HighestHz / spectrogram.HertzPerRow, spectrogram.Rows);
                for (int x = 0; x < width; ++x)
                {
                    (int before, float across) = Place(
                        (x + 0.5) / width * spectrogram.Columns - 0.5, spectrogram.Columns);
                    int corner = before * spectrogram.Rows + low;
                    float first = shares[corner] + up * (shares[corner + 1] - shares[corner]);
                    corner += spectrogram.Rows;
                    float second = shares[corner] + up * (shares[corner + 1] - shares[corner]);
                    canvas.SetPixel(left + x, top + y, ColourMap.At(first + across * (second - first)));
                }
            }
        }

        /// <summary>What the colours mean, as a bar with a scale right of it.</summary>
        public static void DrawLegend(PixelCanvas canvas, Palette palette, Box bar, double topDecibels)
        {
            Box sharp = bar.Snapped(canvas.Scale);
            var pixels = (int)Math.Round(sharp.Height * canvas.Scale);
            for (int row = 0; row < pixels; ++row)
            {
                Box line = sharp.Rows(row / canvas.Scale, 1.0 / canvas.Scale);
                canvas.Fill(line, ColourMap.At(1.0 - (row + 0.5) / pixels));
            }
            foreach (double level in Enumerable.Range(0, 4).Select(step => topDecibels - step * RangeDecibels / 3.0))
            {
                double y = bar.Top + bar.Height * (topDecibels - level) / RangeDecibels;
                canvas.Text(Scale.Text(level, 0), bar.Right + 5.0,
                    Math.Max(bar.Top + 4.0, Math.Min(bar.Bottom - 4.0, y)), Plot.ScaleSize, palette.Soft);
            }
            canvas.Text("dB", bar.Left, bar.Bottom + 10.0, Plot.ScaleSize, palette.Soft);
        }

        /// <summary>Of the colour map, by column and row; silence is at its beginning.</summary>
        private static float[] Shares(Spectrogram spectrogram, double topDecibels)
        {
            var shares = new float[spectrogram.Columns * spectrogram.Rows];
            for (int index = 0; index < shares.Length; ++index)
            {
                double level = spectrogram.Decibels(index / spectrogram.Rows, index % spectrogram.Rows);
                shares[index] = (float)Math.Max(0.0, Math.Min(1.0, 1.0 + (level - topDecibels) / RangeDecibels));
            }
            return shares;
        }

        /// <summary>The neighbour below a place, and how far it is to the one above.</summary>
        private static (int Below, float Share) Place(double place, int count)
        {
            int below = Math.Max(0, Math.Min(count - 2, (int)Math.Floor(place)));
            return (below, (float)Math.Max(0.0, Math.Min(1.0, place - below)));
        }
    }
}
