#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Preview
{
    /// <summary>Draws acceleration over time: each column of pixels shows the extremes, and brighter the RMS, of its
    /// samples.</summary>
    internal static class WaveformChart
    {
        private static readonly double[] Limits = { 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0 };

        /// <summary>A round number for the upper edge that holds a peak with little room above, in m/s^2.</summary>
        public static double Limit(double peakMps2)
        {
            double limited = Math.Max(0.01, peakMps2);
            double power = Math.Pow(10.0, Math.Floor(Math.Log10(limited)));
            return power * Array.Find(Limits, limit => limit * power >= limited);
        }

        /// <param name="frame">The plot area; the axis numbers stand left of it.</param>
        /// <param name="limitMps2">Acceleration at the upper edge.</param>
        public static void Draw(
            ICanvas canvas, Palette palette, Box frame, PreviewSound sound, Colour colour, double limitMps2)
        {
            var plot = new Plot(canvas, palette, frame, (0.0, sound.DurationSeconds), (-limitMps2, limitMps2));
            plot.Columns(AxisNumbers.Ticks(0.0, sound.DurationSeconds, 6));
            plot.Rows(new[] { -limitMps2, 0.0, limitMps2 }, value => AxisNumbers.Text(value, 2));
            int columns = Math.Max(1, (int)Math.Round(plot.Frame.Width * canvas.PixelsPerPoint));
            double pixel = 1.0 / canvas.PixelsPerPoint;
            var extremes = new List<(double X, double Top, double Bottom)>(2 * columns);
            var rms = new List<(double X, double Top, double Bottom)>(2 * columns);
            for (int column = 0; column < columns; ++column)
            {
                (double low, double high, double level) = Column(sound, column, columns);
                double x = plot.Frame.Left + column * pixel;
                AddColumn(extremes, plot, x, low, high, pixel);
                AddColumn(rms, plot, x, -level, level, pixel);
            }
            canvas.FillArea(extremes, Colour.Between(palette.Plot, colour, 0.5));
            canvas.FillArea(rms, colour);
        }

        /// <summary>A step as wide as the column, and at least a pixel high, so that silence is a line.</summary>
        private static void AddColumn(List<(double X, double Top, double Bottom)> edges, Plot plot, double x,
            double low, double high, double pixel)
        {
            double top = plot.Y(high) - 0.5 * pixel;
            double bottom = top + Math.Max(pixel, plot.Y(low) - plot.Y(high));
            edges.Add((x, top, bottom));
            edges.Add((x + pixel, top, bottom));
        }

        /// <summary>Extremes and RMS of the samples of a column, in m/s^2.</summary>
        private static (double Low, double High, double Rms) Column(PreviewSound sound, int column, int columns)
        {
            float[] samples = sound.Samples;
            var begin = (int)((long)samples.Length * column / columns);
            var next = (int)((long)samples.Length * (column + 1) / columns);
            int end = Math.Min(samples.Length, Math.Max(begin + 1, next));
            float low = float.MaxValue;
            float high = float.MinValue;
            double squares = 0.0;
            for (int index = begin; index < end; ++index)
            {
                float sample = samples[index];
                low = sample < low ? sample : low;
                high = sample > high ? sample : high;
                squares += sample * sample;
            }
            const double unit = PreviewSound.FullScaleMps2;
            return (unit * low, unit * high, unit * Math.Sqrt(squares / (end - begin)));
        }
    }

    /// <summary>Draws power spectral density over time and frequency as colours.</summary>
    internal static class SpectrogramChart
    {
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

    /// <summary>Draws the mean power spectral density from 20 to 1000 Hz over a logarithmic frequency axis.</summary>
    internal static class SpectrumChart
    {
        public const double RangeDecibels = 70.0;

        private static readonly double[] GridHz = { 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0 };

        /// <param name="frame">The plot area; the axis numbers stand left of it and below.</param>
        /// <param name="topDecibels">Level at the upper edge, dB re 1 (m/s^2)^2/Hz.</param>
        public static void Draw(ICanvas canvas, Palette palette, Box frame, double topDecibels,
            params (Spectrum Spectrum, Colour Colour)[] curves)
        {
            var plot = new Plot(canvas, palette, frame,
                (Math.Log10(Spectrum.MinimumHz), Math.Log10(Spectrum.MaximumHz)),
                (topDecibels - RangeDecibels, topDecibels));
            double[] columns = Array.ConvertAll(GridHz, Math.Log10);
            plot.Columns(columns);
            plot.Rows(AxisNumbers.Ticks(topDecibels - RangeDecibels, topDecibels, frame.Height > 130.0 ? 8 : 4),
                value => AxisNumbers.Text(value, 0));
            plot.ColumnTexts(columns, value => AxisNumbers.Text(Math.Pow(10.0, value), 0), "Hz");
            foreach ((Spectrum spectrum, Colour colour) in curves)
            {
                DrawCurve(canvas, plot, spectrum, colour);
            }
        }

        /// <summary>The highest level that the curve of a spectrum reaches in this chart, in decibels.</summary>
        public static double Highest(Spectrum spectrum) =>
            spectrum.DecibelsBetween(Spectrum.MinimumHz, Spectrum.MaximumHz);

        /// <summary>Each column of pixels shows the highest level of its band: no narrow peak is lost.</summary>
        private static void DrawCurve(ICanvas canvas, Plot plot, Spectrum spectrum, Colour colour)
        {
            var points = new List<(double X, double Y)>();
            var area = new List<(double X, double Top, double Bottom)>();
            double step = 1.0 / canvas.PixelsPerPoint;
            for (double x = 0.0; x < plot.Frame.Width; x += step)
            {
                double y = plot.Y(spectrum.DecibelsBetween(Hertz(plot, x), Hertz(plot, x + step)));
                points.Add((plot.Frame.Left + x + 0.5 * step, y));
                area.Add((plot.Frame.Left + x + 0.5 * step, y, plot.Frame.Bottom));
            }
            canvas.FillArea(area, colour.WithOpacity(0.13));
            canvas.DrawPolyline(points, 1.5, colour);
        }

        private static double Hertz(Plot plot, double x)
        {
            double share = x / plot.Frame.Width;
            return Spectrum.MinimumHz * Math.Pow(Spectrum.MaximumHz / Spectrum.MinimumHz, share);
        }
    }
}
