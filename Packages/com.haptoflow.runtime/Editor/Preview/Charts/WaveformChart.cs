#nullable enable
using System;

namespace HaptoFlow.Preview
{
    /// <summary>Acceleration over time: for each column of pixels its extremes, and brighter its RMS.</summary>
    internal static class WaveformChart
    {
        private static readonly double[] Limits = { 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0 };

        /// <summary>A round number that holds a peak, in m/s^2, with little room above.</summary>
        public static double Limit(double peakMps2)
        {
            double held = Math.Max(0.01, peakMps2);
            double power = Math.Pow(10.0, Math.Floor(Math.Log10(held)));
            return power * Array.Find(Limits, limit => limit * power >= held);
        }

        /// <param name="frame">The plot itself; the scale is drawn left of it.</param>
        /// <param name="limitMps2">At the upper edge.</param>
        public static void Draw(
            PixelCanvas canvas, Palette palette, Box frame, PreviewSound sound, Colour colour, double limitMps2)
        {
            var plot = new Plot(canvas, palette, frame, (0.0, sound.DurationSeconds), (-limitMps2, limitMps2));
            plot.Columns(Scale.Ticks(0.0, sound.DurationSeconds, 6));
            plot.Rows(new[] { -limitMps2, 0.0, limitMps2 }, value => Scale.Text(value, 2));
            Colour extremes = Colour.Between(palette.Plot, colour, 0.5);
            int columns = (int)Math.Round(plot.Frame.Width * canvas.Scale);
            double pixel = 1.0 / canvas.Scale;
            for (int column = 0; column < columns; ++column)
            {
                (double low, double high, double rms) = Column(sound, column, columns);
                double x = plot.Frame.Left + column * pixel;
                FillColumn(canvas, plot, x, low, high, extremes);
                FillColumn(canvas, plot, x, -rms, rms, colour);
            }
        }

        private static void FillColumn(
            PixelCanvas canvas, Plot plot, double x, double low, double high, Colour colour)
        {
            double line = 1.0 / canvas.Scale;
            double top = plot.Y(high) - 0.5 * line;
            canvas.Fill(new Box(x, top, line, Math.Max(line, plot.Y(low) - plot.Y(high))), colour);
        }

        private static (double Low, double High, double Rms) Column(PreviewSound sound, int column, int columns)
        {
            long begin = (long)sound.Samples.Length * column / columns;
            long end = Math.Max(begin + 1, (long)sound.Samples.Length * (column + 1) / columns);
            double low = double.MaxValue;
            double high = double.MinValue;
            double squares = 0.0;
            for (long index = begin; index < end && index < sound.Samples.Length; ++index)
            {
                double value = PreviewSound.FullScaleMps2 * sound.Samples[index];
                low = Math.Min(low, value);
                high = Math.Max(high, value);
                squares += value * value;
            }
            return (low, high, Math.Sqrt(squares / (end - begin)));
        }
    }
}
