#nullable enable
using System;
using System.Collections.Generic;

namespace HaptoFlow.Preview
{
    /// <summary>Mean power spectral density from 20 to 1000 Hz, frequency on a logarithmic scale.</summary>
    internal static class SpectrumChart
    {
        /// <summary>From the lower to the upper edge.</summary>
        public const double RangeDecibels = 70.0;

        private static readonly double[] ColumnsHz = { 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0 };

        /// <param name="frame">The plot itself; scales are drawn left of it and below.</param>
        /// <param name="topDecibels">At the upper edge, dB re 1 (m/s^2)^2/Hz.</param>
        public static void Draw(PixelCanvas canvas, Palette palette, Box frame, double topDecibels,
            params (Spectrum Spectrum, Colour Colour)[] curves)
        {
            var plot = new Plot(canvas, palette, frame,
                (Math.Log10(Spectrum.LowestHz), Math.Log10(Spectrum.HighestHz)),
                (topDecibels - RangeDecibels, topDecibels));
            foreach (double hertz in ColumnsHz)
            {
                plot.Columns(new[] { Math.Log10(hertz) });
            }
            plot.Rows(Scale.Ticks(topDecibels - RangeDecibels, topDecibels, frame.Height > 130.0 ? 8 : 4),
                value => Scale.Text(value, 0));
            plot.ColumnTexts(Array.ConvertAll(ColumnsHz, Math.Log10), value => Scale.Text(Math.Pow(10.0, value), 0),
                "Hz");
            foreach ((Spectrum spectrum, Colour colour) in curves)
            {
                DrawCurve(canvas, plot, spectrum, colour);
            }
        }

        /// <summary>The highest that a curve of this chart reaches.</summary>
        public static double Highest(Spectrum spectrum) =>
            spectrum.DecibelsBetween(Spectrum.LowestHz, Spectrum.HighestHz);

        private static void DrawCurve(PixelCanvas canvas, Plot plot, Spectrum spectrum, Colour colour)
        {
            var points = new List<(double X, double Y)>();
            double step = 1.0 / canvas.Scale;
            Colour shade = colour.WithOpacity(0.13);
            for (double x = 0.0; x < plot.Frame.Width; x += step)
            {
                double level = spectrum.DecibelsBetween(Hertz(plot, x), Hertz(plot, x + step));
                double y = plot.Y(level);
                points.Add((plot.Frame.Left + x + 0.5 * step, y));
                canvas.Fill(new Box(plot.Frame.Left + x, y, step, plot.Frame.Bottom - y), shade);
            }
            canvas.Polyline(points, 1.5, colour);
        }

        private static double Hertz(Plot plot, double x)
        {
            double share = x / plot.Frame.Width;
            return Spectrum.LowestHz * Math.Pow(Spectrum.HighestHz / Spectrum.LowestHz, share);
        }
    }
}
