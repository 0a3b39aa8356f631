#nullable enable
using System;
using System.Collections.Generic;

namespace HaptoFlow.Preview
{
    /// <summary>The plot area of a chart: converts values to points, and draws the grid and the axis numbers.</summary>
    internal sealed class Plot
    {
        /// <summary>Font size of axis numbers, in points.</summary>
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

        /// <summary>Draws vertical grid lines.</summary>
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
}
