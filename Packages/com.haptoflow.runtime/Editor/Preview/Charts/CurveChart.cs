#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Preview
{
    /// <summary>One plot with a logarithmic horizontal axis, of frequency or of speed, and the curves in it.</summary>
    internal sealed class CurveChart
    {
        private const double LineWidth = 1.6;
        private const double PointRadius = 2.6;

        private static readonly double[] Frequencies = { 20.0, 50.0, 100.0, 200.0, 500.0 };
        private static readonly double[] Speeds = { 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0 };

        private readonly ICanvas canvas;
        private readonly Plot plot;

        private CurveChart(ICanvas canvas, Palette palette, Box frame, (double Low, double High) horizontal,
            (double Low, double High) vertical, IReadOnlyList<double> grid, string unit)
        {
            this.canvas = canvas;
            plot = new Plot(canvas, palette, frame, (Math.Log10(horizontal.Low), Math.Log10(horizontal.High)), vertical);
            double[] columns = grid.Where(each => each >= horizontal.Low && each <= horizontal.High * 1.001)
                .Select(Math.Log10).ToArray();
            plot.Columns(columns);
            plot.ColumnTexts(columns, value => AxisNumbers.Text(Math.Pow(10.0, value), 0), unit);
        }

        /// <summary>A plot over frequency in Hz, rising.</summary>
        public static CurveChart OverFrequency(ICanvas canvas, Palette palette, Box frame,
            IReadOnlyList<double> frequenciesHz, (double Low, double High) vertical) =>
            new CurveChart(canvas, palette, frame, (frequenciesHz[0], frequenciesHz[frequenciesHz.Count - 1]), vertical,
                Frequencies, "Hz");

        /// <summary>A plot over speed in mm/s, rising.</summary>
        public static CurveChart OverSpeed(ICanvas canvas, Palette palette, Box frame,
            IReadOnlyList<double> speedsMps, (double Low, double High) vertical) =>
            new CurveChart(canvas, palette, frame,
                (1000.0 * speedsMps[0], 1000.0 * speedsMps[speedsMps.Count - 1]), vertical, Speeds, "mm/s");

        /// <summary>Horizontal grid lines with their numbers.</summary>
        public void Rows(IEnumerable<double> values, Func<double, string> text) => plot.Rows(values, text);

        /// <summary>Shades a range of the horizontal axis.</summary>
        public void Shade(double low, double high, Colour colour)
        {
            double left = Math.Max(plot.Frame.Left, plot.X(Math.Log10(low)));
            double right = Math.Min(plot.Frame.Right, plot.X(Math.Log10(high)));
            canvas.FillRectangle(new Box(left, plot.Frame.Top, Math.Max(0.0, right - left), plot.Frame.Height), colour);
        }

        /// <summary>A line through values at places of the horizontal axis.</summary>
        public void Line(IEnumerable<(double Across, double Value)> values, Colour colour, bool isDashed = false)
        {
            (double, double)[] points = values.Select(Point).ToArray();
            if (points.Length < 2)
            {
                return;
            }
            if (isDashed)
            {
                canvas.DrawDashes(points, LineWidth, colour);
            }
            else
            {
                canvas.DrawPolyline(points, LineWidth, colour);
            }
        }

        /// <summary>A disc at each value.</summary>
        public void Points(IEnumerable<(double Across, double Value)> values, Colour colour)
        {
            foreach ((double x, double y) in values.Select(Point))
            {
                canvas.FillCircle(x, y, PointRadius, colour);
            }
        }

        private (double X, double Y) Point((double Across, double Value) each) =>
            (plot.X(Math.Log10(each.Across)), plot.Y(each.Value));
    }
}
