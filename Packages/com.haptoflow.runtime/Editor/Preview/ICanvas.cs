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

        public Box Inside(double left, double top, double right, double bottom) =>
            new Box(Left + left, Top + top, Width - left - right, Height - top - bottom);

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

    /// <summary>An sRGB colour with opacity, each channel from 0 to 255.</summary>
    internal readonly struct Colour
    {
        public Colour(byte red, byte green, byte blue, byte opacity = 255) =>
            (Red, Green, Blue, Opacity) = (red, green, blue, opacity);

        public byte Red { get; }
        public byte Green { get; }
        public byte Blue { get; }
        public byte Opacity { get; }

        /// <param name="rgb">0xRRGGBB, opaque.</param>
        public static Colour Of(int rgb) => new Colour((byte)(rgb >> 16), (byte)(rgb >> 8), (byte)rgb);

        /// <param name="share">0 to 1.</param>
        public Colour WithOpacity(double share) =>
            new Colour(Red, Green, Blue, (byte)Math.Round(255.0 * Math.Max(0.0, Math.Min(1.0, share))));

        /// <param name="share">0 gives the first colour, 1 the second.</param>
        public static Colour Between(Colour first, Colour second, double share) => new Colour(
            Mix(first.Red, second.Red, share), Mix(first.Green, second.Green, share),
            Mix(first.Blue, second.Blue, share), Mix(first.Opacity, second.Opacity, share));

        private static byte Mix(byte first, byte second, double share) =>
            (byte)Math.Round(first + share * (second - first));
    }

    /// <summary>The colours of the charts, one palette for each skin of the editor.</summary>
    /// <param name="Soft">Secondary text: axis numbers and remarks.</param>
    internal sealed record Palette(Colour Window, Colour Card, Colour Plot, Colour Grid, Colour Ink, Colour Soft,
        Colour First, Colour Second, Colour Speed, Colour Force, Colour Patch)
    {
        public static readonly Palette Dark = new Palette(
            Window: Colour.Of(0x383838),
            Card: Colour.Of(0x26282c),
            Plot: Colour.Of(0x1b1d20),
            Grid: Colour.Of(0x383c43),
            Ink: Colour.Of(0xeceae6),
            Soft: Colour.Of(0xa6acb6),
            First: Colour.Of(0x5fb4f5),
            Second: Colour.Of(0xffa34d),
            Speed: Colour.Of(0x63d0b2),
            Force: Colour.Of(0xee8fc7),
            Patch: Colour.Of(0x33373d));

        public static readonly Palette Light = new Palette(
            Window: Colour.Of(0xc8c8c8),
            Card: Colour.Of(0xf5f4f1),
            Plot: Colour.Of(0xffffff),
            Grid: Colour.Of(0xdedbd4),
            Ink: Colour.Of(0x1f2227),
            Soft: Colour.Of(0x565c66),
            First: Colour.Of(0x1a6bb0),
            Second: Colour.Of(0xb24b06),
            Speed: Colour.Of(0x0c7a66),
            Force: Colour.Of(0xa8357f),
            Patch: Colour.Of(0xe6e0d4));
    }

    /// <summary>Matplotlib's colour map "inferno" (CC0), interpolated between 17 evenly spaced colours. Its lightness
    /// rises steadily, so that a higher value always looks brighter.</summary>
    internal static class ColourMap
    {
        private static readonly int[] Steps =
        {
            0x000004, 0x0b0724, 0x210c4a, 0x3d0965, 0x57106e, 0x71196e, 0x8a226a, 0xa32c61, 0xbc3754,
            0xd24645, 0xe45a31, 0xf1731d, 0xf98e09, 0xfcac11, 0xf9cb35, 0xf2ea69, 0xfcffa4,
        };

        private static readonly Colour[] Table = Fill();

        /// <summary>All colours, the darkest in the lowest row: for legends.</summary>
        public static ColourImage Column { get; } = MakeColumn();

        /// <param name="share">0 to 1; NaN counts as 0.</param>
        public static Colour At(double share)
        {
            double limited = share > 0.0 ? Math.Min(1.0, share) : 0.0;
            return Table[(int)(limited * (Table.Length - 1) + 0.5)];
        }

        private static ColourImage MakeColumn()
        {
            var image = new ColourImage(1, Table.Length);
            for (int y = 0; y < Table.Length; ++y)
            {
                image.Set(0, y, Table[y]);
            }
            return image;
        }

        private static Colour[] Fill()
        {
            var table = new Colour[256];
            for (int index = 0; index < table.Length; ++index)
            {
                double place = index * (Steps.Length - 1) / (table.Length - 1.0);
                int lower = Math.Min((int)place, Steps.Length - 2);
                table[index] = Colour.Between(Colour.Of(Steps[lower]), Colour.Of(Steps[lower + 1]), place - lower);
            }
            return table;
        }
    }

    /// <summary>A buffer of opaque colours. Immutable by convention: a texture made from it stays valid.</summary>
    internal sealed record ColourImage(int Width, int Height)
    {
        public const int BytesPerPixel = 4;

        /// <summary>Red, green, blue and opacity of each pixel. The lowest row is first, as in textures.</summary>
        public byte[] Pixels { get; } = new byte[Width * Height * BytesPerPixel];

        /// <param name="y">0 is the lowest row.</param>
        public void Set(int x, int y, Colour colour)
        {
            int index = (y * Width + x) * BytesPerPixel;
            Pixels[index] = colour.Red;
            Pixels[index + 1] = colour.Green;
            Pixels[index + 2] = colour.Blue;
            Pixels[index + 3] = colour.Opacity;
        }
    }
}
