#nullable enable
using System;

namespace HaptoFlow.Preview
{
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
}
