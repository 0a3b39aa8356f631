#nullable enable
using System;
using System.Linq;

namespace HaptoFlow.Preview
{
    /// <summary>Draws power spectral density over time and frequency as colours.</summary>
    internal static class SpectrogramChart
    {
        /// <summary>Level difference between black and the brightest colour.</summary>
        public const double RangeDecibels = 60.0;

        private const int ImageRows = 256;

        private static readonly double[] AxisHz = { 0.0, 250.0, 500.0, 750.0, 1000.0 };

        /// <param name="frame">The plot area; the axis numbers stand left of it and below.</param>
        /// <param name="image">Made by <see cref="Image"/>.</param>
        public static void Draw(ICanvas canvas, Palette palette, Box frame, ColourImage image, double durationSeconds)
        {
            var plot = new Plot(canvas, palette, frame, (0.0, durationSeconds), (0.0, Spectrum.MaximumHz));
            foreach (double hertz in AxisHz)
            {
                plot.RowText(
                    AxisNumbers.Text(hertz, 0), plot.Y(hertz), frame.Left - 6.0, TextAlign.Right, palette.Soft);
            }
            plot.ColumnTexts(AxisNumbers.Ticks(0.0, durationSeconds, 6), value => AxisNumbers.Text(value, 2), "s");
            canvas.DrawImage(image, plot.Frame);
        }

        /// <summary>One column of pixels for each of the spectrogram's; the rows cover 0 Hz to
        /// <see cref="Spectrum.MaximumHz"/> evenly. Any thread.</summary>
        /// <param name="topDecibels">Level of the brightest colour, dB re 1 (m/s^2)^2/Hz.</param>
        public static ColourImage Image(Spectrogram spectrogram, double topDecibels)
        {
            var image = new ColourImage(spectrogram.Columns, ImageRows);
            for (int y = 0; y < ImageRows; ++y)
            {
                double place = (y + 0.5) / ImageRows * Spectrum.MaximumHz / spectrogram.HertzPerRow;
                int row = Math.Min(spectrogram.Rows - 2, (int)place);
                for (int x = 0; x < spectrogram.Columns; ++x)
                {
                    double low = Share(spectrogram.Decibels(x, row), topDecibels);
                    double high = Share(spectrogram.Decibels(x, row + 1), topDecibels);
                    image.Set(x, y, ColourMap.At(low + (place - row) * (high - low)));
                }
            }
            return image;
        }

        /// <summary>A bar of all colours, with their levels right of it.</summary>
        public static void DrawLegend(ICanvas canvas, Palette palette, Box bar, double topDecibels)
        {
            Box sharp = bar.Snapped(canvas.PixelsPerPoint);
            canvas.DrawImage(ColourMap.Column, sharp);
            foreach (double level in Enumerable.Range(0, 4).Select(step => topDecibels - step * RangeDecibels / 3.0))
            {
                double y = bar.Top + bar.Height * (topDecibels - level) / RangeDecibels;
                canvas.DrawText(AxisNumbers.Text(level, 0), bar.Right + 5.0,
                    Math.Max(bar.Top + 4.0, Math.Min(bar.Bottom - 4.0, y)), Plot.NumberSize, palette.Soft);
            }
            canvas.DrawText("dB", bar.Left, bar.Bottom + 10.0, Plot.NumberSize, palette.Soft);
        }

        /// <summary>Place of a level in the colour map: 0 for silence, 1 for the top.</summary>
        private static double Share(double decibels, double topDecibels) =>
            Math.Max(0.0, Math.Min(1.0, 1.0 + (decibels - topDecibels) / RangeDecibels));
    }
}
