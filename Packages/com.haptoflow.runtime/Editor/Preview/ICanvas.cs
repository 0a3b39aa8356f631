#nullable enable
using System;
using System.Collections.Generic;

namespace HaptoFlow.Preview
{
    /// <summary>Which part of a text stands at its x.</summary>
    internal enum TextAlign
    {
        Left,
        Centre,
        Right,
    }

    /// <summary>What the charts draw on. Lengths are in points, y downwards. In the editor it is implemented with
    /// Unity's IMGUI; tests implement it with SkiaSharp, to check charts and to make the documentation's pictures.
    /// </summary>
    internal interface ICanvas
    {
        /// <summary>1, or more on a screen with dense pixels.</summary>
        double PixelsPerPoint { get; }

        void FillRectangle(Box box, Colour colour, double cornerRadius = 0.0);

        /// <summary>An antialiased line through points, with round joints where the implementation has them.</summary>
        void DrawPolyline(IReadOnlyList<(double X, double Y)> points, double width, Colour colour);

        /// <summary>Fills the area between an upper and a lower edge, both given at the same ascending x and straight
        /// in between.</summary>
        void FillArea(IReadOnlyList<(double X, double Top, double Bottom)> edges, Colour colour);

        /// <summary>One line of text.</summary>
        /// <param name="y">Of the middle of the capitals.</param>
        /// <param name="size">Of the font, in points.</param>
        void DrawText(string text, double x, double y, double size, Colour colour,
            TextAlign align = TextAlign.Left, bool bold = false);

        double MeasureText(string text, double size, bool bold = false);

        /// <summary>Stretches an image over a box, with linear interpolation.</summary>
        void DrawImage(ColourImage image, Box box);

        /// <summary>Cuts off what is drawn outside a box, until <see cref="EndClip"/>. Clips do not nest.</summary>
        void BeginClip(Box box);

        void EndClip();
    }

    /// <summary>Shapes made of the calls of <see cref="ICanvas"/>.</summary>
    internal static class CanvasShapes
    {
        public static void DrawLine(
            this ICanvas canvas, double x0, double y0, double x1, double y1, double width, Colour colour) =>
            canvas.DrawPolyline(new[] { (x0, y0), (x1, y1) }, width, colour);

        /// <summary>A horizontal line, one pixel wide and aligned to the pixels.</summary>
        public static void DrawHorizontalHairline(
            this ICanvas canvas, double left, double right, double y, Colour colour)
        {
            double pixel = 1.0 / canvas.PixelsPerPoint;
            canvas.FillRectangle(new Box(left, Math.Floor(y / pixel) * pixel, right - left, pixel), colour);
        }

        /// <summary>A vertical line, one pixel wide and aligned to the pixels.</summary>
        public static void DrawVerticalHairline(
            this ICanvas canvas, double x, double top, double bottom, Colour colour)
        {
            double pixel = 1.0 / canvas.PixelsPerPoint;
            canvas.FillRectangle(new Box(Math.Floor(x / pixel) * pixel, top, pixel, bottom - top), colour);
        }

        public static void FillCircle(this ICanvas canvas, double x, double y, double radius, Colour colour) =>
            canvas.FillRectangle(new Box(x - radius, y - radius, 2.0 * radius, 2.0 * radius), colour, radius);

        /// <summary>The text, or what of it is no wider than <paramref name="width"/>, ending in an ellipsis.</summary>
        public static string FitText(this ICanvas canvas, string text, double size, double width, bool bold = false)
        {
            if (canvas.MeasureText(text, size, bold) <= width)
            {
                return text;
            }
            for (int length = text.Length - 1; length > 0; --length)
            {
                string shortened = text.Substring(0, length).TrimEnd() + "\u2026";
                if (canvas.MeasureText(shortened, size, bold) <= width)
                {
                    return shortened;
                }
            }
            return "\u2026";
        }
    }

    /// <summary>A rectangle in points, y downwards.</summary>
    internal readonly struct Box
    {
        public Box(double left, double top, double width, double height) =>
            (Left, Top, Width, Height) = (left, top, width, height);

        public double Left { get; }
        public double Top { get; }
        public double Width { get; }
        public double Height { get; }

        public double Right => Left + Width;

        public double Bottom => Top + Height;

        public double MiddleX => Left + 0.5 * Width;

        public double MiddleY => Top + 0.5 * Height;

        /// <summary>This box without a margin on each side.</summary>
        public Box Inside(double left, double top, double right, double bottom) =>
            new Box(Left + left, Top + top, Width - left - right, Height - top - bottom);

        /// <summary>This box without the same margin on every side.</summary>
        public Box Inside(double margin) => Inside(margin, margin, margin, margin);

        /// <summary>This box with its edges rounded to the edges of pixels, so that they are sharp.</summary>
        public Box Snapped(double pixelsPerPoint)
        {
            double left = Math.Round(Left * pixelsPerPoint) / pixelsPerPoint;
            double top = Math.Round(Top * pixelsPerPoint) / pixelsPerPoint;
            double right = Math.Round(Right * pixelsPerPoint) / pixelsPerPoint;
            double bottom = Math.Round(Bottom * pixelsPerPoint) / pixelsPerPoint;
            return new Box(left, top, right - left, bottom - top);
        }

        public bool Contains(double x, double y) => x >= Left && x <= Right && y >= Top && y <= Bottom;

        /// <summary>A part of this box over its whole height.</summary>
        /// <param name="from">Distance of its left edge from the left edge of this box.</param>
        public Box Columns(double from, double width) => new Box(Left + from, Top, width, Height);

        /// <summary>A part of this box over its whole width.</summary>
        /// <param name="from">Distance of its top edge from the top edge of this box.</param>
        public Box Rows(double from, double height) => new Box(Left, Top + from, Width, height);
    }

    /// <summary>Dashed lines.</summary>
    internal static class Dashes
    {
        private const double DashPoints = 5.0;
        private const double GapPoints = 4.0;

        /// <summary>Draws a polyline in dashes of 5 points with gaps of 4.</summary>
        public static void DrawDashes(
            this ICanvas canvas, IReadOnlyList<(double X, double Y)> points, double width, Colour colour)
        {
            var dash = new List<(double X, double Y)>();
            double gone = 0.0;
            for (int index = 1; index < points.Count; ++index)
            {
                (double x, double y) = points[index - 1];
                (double alongX, double alongY) = (points[index].X - x, points[index].Y - y);
                double length = Math.Sqrt(alongX * alongX + alongY * alongY);
                int steps = Math.Max(1, (int)Math.Ceiling(length));
                for (int step = 0; step <= steps; ++step)
                {
                    double share = step / (double)steps;
                    if ((gone + share * length) % (DashPoints + GapPoints) <= DashPoints)
                    {
                        dash.Add((x + share * alongX, y + share * alongY));
                    }
                    else if (dash.Count > 0)
                    {
                        canvas.DrawPolyline(dash, width, colour);
                        dash.Clear();
                    }
                }
                gone += length;
            }
            if (dash.Count > 1)
            {
                canvas.DrawPolyline(dash, width, colour);
            }
        }
    }
}
