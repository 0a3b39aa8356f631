#nullable enable
using System;

namespace HaptoFlow.Preview
{
    /// <summary>A rectangle in points, y downwards.</summary>
    internal readonly struct Box
    {
        public Box(double left, double top, double width, double height)
        {
            Left = left;
            Top = top;
            Width = width;
            Height = height;
        }

        public double Left { get; }

        public double Top { get; }

        public double Width { get; }

        public double Height { get; }

        public double Right => Left + Width;

        public double Bottom => Top + Height;

        public double MiddleX => Left + 0.5 * Width;

        public double MiddleY => Top + 0.5 * Height;

        /// <summary>Smaller by these margins.</summary>
        public Box Inside(double left, double top, double right, double bottom) =>
            new Box(Left + left, Top + top, Width - left - right, Height - top - bottom);

        /// <summary>Smaller by the same margin everywhere.</summary>
        public Box Inside(double margin) => Inside(margin, margin, margin, margin);

        /// <summary>With its edges between pixels: sharp.</summary>
        /// <param name="scale">Pixels of a point.</param>
        public Box Snapped(double scale)
        {
            double left = Math.Round(Left * scale);
            double top = Math.Round(Top * scale);
            return new Box(left / scale, top / scale, (Math.Round(Right * scale) - left) / scale,
                (Math.Round(Bottom * scale) - top) / scale);
        }

        public bool Contains(double x, double y) => x >= Left && x <= Right && y >= Top && y <= Bottom;

        /// <summary>A part of it, counted from its left edge.</summary>
        public Box Columns(double from, double width) => new Box(Left + from, Top, width, Height);

        /// <summary>A part of it, counted from its top edge.</summary>
        public Box Rows(double from, double height) => new Box(Left, Top + from, Width, height);
    }
}
