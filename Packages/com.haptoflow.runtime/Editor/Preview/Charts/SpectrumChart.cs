#nullable enable
using System;
using System.Collections.Generic;

namespace HaptoFlow.Preview
{
    /// <summary>Draws the mean power spectral density from 20 to 1000 Hz over a logarithmic frequency axis.</summary>
    internal static class SpectrumChart
    {
        /// <summary>Height of the level axis.</summary>
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
