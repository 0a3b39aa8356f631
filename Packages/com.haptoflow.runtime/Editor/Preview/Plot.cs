#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;

namespace HaptoFlow.Preview
{
    /// <summary>The plot area of a chart: converts values to points, and draws the grid and the axis numbers.</summary>
    internal sealed class Plot
    {
        public const double NumberSize = 10.0;

        // Between two axis numbers, in points.
        private const double MinimumGap = 5.0;

        private readonly ICanvas canvas;
        private readonly Palette palette;
        private readonly (double Low, double High) horizontal;
        private readonly (double Low, double High) vertical;

        public Plot(ICanvas canvas, Palette palette, Box frame, (double Low, double High) horizontal,
            (double Low, double High) vertical)
        {
            this.canvas = canvas;
            this.palette = palette;
            this.horizontal = horizontal;
            this.vertical = vertical;
            Frame = frame.Snapped(canvas.PixelsPerPoint);
            canvas.FillRectangle(Frame, palette.Plot);
        }

        public Box Frame { get; }

        public double X(double value) =>
            Frame.Left + Frame.Width * (value - horizontal.Low) / (horizontal.High - horizontal.Low);

        /// <summary>Limited to the plot area.</summary>
        public double Y(double value)
        {
            double share = (value - vertical.Low) / (vertical.High - vertical.Low);
            return Frame.Bottom - Frame.Height * Math.Max(0.0, Math.Min(1.0, share));
        }

        /// <summary>Draws horizontal grid lines, and their numbers left of them.</summary>
        public void Rows(IEnumerable<double> values, Func<double, string> text)
        {
            foreach (double value in values)
            {
                double y = Y(value);
                canvas.DrawHorizontalHairline(Frame.Left, Frame.Right, Math.Min(y, Frame.Bottom - 1.0), palette.Grid);
                RowText(text(value), y, Frame.Left - 6.0, TextAlign.Right, palette.Soft);
            }
        }

        /// <summary>Draws a number beside the plot area, within its height.</summary>
        public void RowText(string text, double y, double x, TextAlign align, Colour colour)
        {
            double limited = Math.Max(Frame.Top + 4.0, Math.Min(Frame.Bottom - 4.0, y));
            canvas.DrawText(text, x, limited, NumberSize, colour, align);
        }

        public void Columns(IEnumerable<double> values)
        {
            foreach (double value in values)
            {
                canvas.DrawVerticalHairline(
                    Math.Min(X(value), Frame.Right - 1.0), Frame.Top, Frame.Bottom, palette.Grid);
            }
        }

        /// <summary>Draws the numbers of the horizontal axis below the plot area, the last one with the unit. A number
        /// that would overlap the next one is left out.</summary>
        public void ColumnTexts(IReadOnlyList<double> values, Func<double, string> text, string unit)
        {
            double end = Frame.Right;
            for (int index = values.Count - 1; index >= 0; --index)
            {
                string number = text(values[index]);
                string label = index == values.Count - 1 ? number + " " + unit : number;
                double width = canvas.MeasureText(label, NumberSize);
                double centred = X(values[index]) - 0.5 * canvas.MeasureText(number, NumberSize);
                double left = Math.Max(Frame.Left, Math.Min(Frame.Right - width, centred));
                if (left + width <= end)
                {
                    canvas.DrawText(label, left, Frame.Bottom + 10.0, NumberSize, palette.Soft);
                    end = left - MinimumGap;
                }
            }
        }
    }

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

        public static CurveChart OverFrequency(ICanvas canvas, Palette palette, Box frame,
            IReadOnlyList<double> frequenciesHz, (double Low, double High) vertical) =>
            new CurveChart(canvas, palette, frame, (frequenciesHz[0], frequenciesHz[frequenciesHz.Count - 1]), vertical,
                Frequencies, "Hz");

        public static CurveChart OverSpeed(ICanvas canvas, Palette palette, Box frame,
            IReadOnlyList<double> speedsMps, (double Low, double High) vertical) =>
            new CurveChart(canvas, palette, frame,
                (1000.0 * speedsMps[0], 1000.0 * speedsMps[speedsMps.Count - 1]), vertical, Speeds, "mm/s");

        public void Rows(IEnumerable<double> values, Func<double, string> text) => plot.Rows(values, text);

        public void Shade(double low, double high, Colour colour)
        {
            double left = Math.Max(plot.Frame.Left, plot.X(Math.Log10(low)));
            double right = Math.Min(plot.Frame.Right, plot.X(Math.Log10(high)));
            canvas.FillRectangle(new Box(left, plot.Frame.Top, Math.Max(0.0, right - left), plot.Frame.Height), colour);
        }

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

    internal static class AxisNumbers
    {
        /// <summary>Multiples of 1, 2 or 5 times a power of ten from <paramref name="low"/> to <paramref name="high"/>.
        /// </summary>
        /// <param name="maximum">Number of intervals.</param>
        public static IReadOnlyList<double> Ticks(double low, double high, int maximum)
        {
            double step = Step(high - low, maximum);
            var ticks = new List<double>();
            for (double tick = Math.Ceiling(low / step - 1e-9) * step; tick <= high + 1e-9 * step; tick += step)
            {
                ticks.Add(Math.Abs(tick) < 1e-9 * step ? 0.0 : tick);
            }
            return ticks;
        }

        /// <summary>The smallest 1, 2 or 5 times a power of ten that is not below a value; 1 if the value is not
        /// positive.</summary>
        public static double RoundUp(double value)
        {
            if (!(value > 0.0))
            {
                return 1.0;
            }
            double power = Math.Pow(10.0, Math.Floor(Math.Log10(value)));
            double share = value / power;
            return power * (share <= 1.0 + 1e-9 ? 1.0 : share <= 2.0 + 1e-9 ? 2.0 : share <= 5.0 + 1e-9 ? 5.0 : 10.0);
        }

        /// <summary>A number for display in every locale, with a typographic minus.</summary>
        /// <param name="digits">Maximum number of digits after the point.</param>
        /// <param name="signed">True for a plus before positive numbers.</param>
        public static string Text(double value, int digits, bool signed = false)
        {
            string zeros = digits > 0 ? "0." + new string('#', digits) : "0";
            return Minus(value, zeros, signed);
        }

        /// <summary>As <see cref="Text"/>, with trailing zeros.</summary>
        public static string Fixed(double value, int digits, bool signed = false) =>
            Minus(value, digits > 0 ? "0." + new string('0', digits) : "0", signed);

        private static double Step(double span, int maximum) => RoundUp(span / Math.Max(1, maximum));

        private static string Minus(double value, string format, bool signed)
        {
            string size = Math.Abs(value).ToString(format, CultureInfo.InvariantCulture);
            bool zero = size.Trim('0', '.').Length == 0;
            return (value < 0.0 && !zero ? "\u2212" : signed && !zero ? "+" : "") + size;
        }
    }

    /// <summary>The background of a group of charts, with a title.</summary>
    internal static class Card
    {
        public const double Gap = 8.0;
        public const double TitleSize = 12.0;

        private const double Radius = 5.0;

        /// <param name="unit">Stands after the title; empty for none.</param>
        /// <param name="margin">From the left edge to the title.</param>
        /// <returns>The height of the middle of the title.</returns>
        public static double Draw(
            ICanvas canvas, Palette palette, Box card, string title, string unit = "", double margin = 12.0)
        {
            double y = card.Top + 17.0;
            double left = card.Left + margin;
            canvas.FillRectangle(card, palette.Card, Radius);
            canvas.DrawText(title, left, y, TitleSize, palette.Ink, bold: true);
            if (unit.Length > 0)
            {
                canvas.DrawText(unit, left + canvas.MeasureText(title, TitleSize, true) + 12.0, y, Plot.NumberSize,
                    palette.Soft);
            }
            return y;
        }
    }
}
