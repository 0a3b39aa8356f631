#nullable enable
using System;
using System.Collections.Generic;

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
}
