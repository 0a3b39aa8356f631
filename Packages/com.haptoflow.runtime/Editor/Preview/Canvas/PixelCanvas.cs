#nullable enable
using System;
using System.Collections.Generic;

namespace HaptoFlow.Preview
{
    /// <summary>Where text stands relative to its x.</summary>
    internal enum TextAlign
    {
        Left,
        Centre,
        Right,
    }

    /// <summary>A picture to draw on, in points: a point is <see cref="Scale"/> pixels. One thread at a time, any.
    /// </summary>
    internal sealed class PixelCanvas
    {
        private const int BytesPerPixel = 4;
        private readonly CoverageMask mask;
        private (int Left, int Top, int Right, int Bottom) clip;

        /// <param name="scale">Pixels of a point: 1, or more on a dense screen.</param>
        public PixelCanvas(double widthPoints, double heightPoints, double scale = 1.0)
        {
            Scale = scale;
            PixelWidth = Math.Max(1, (int)Math.Round(widthPoints * scale));
            PixelHeight = Math.Max(1, (int)Math.Round(heightPoints * scale));
            Pixels = new byte[PixelWidth * PixelHeight * BytesPerPixel];
            mask = new CoverageMask(PixelWidth, PixelHeight);
            ClipTo(null);
        }

        public double Scale { get; }

        public int PixelWidth { get; }

        public int PixelHeight { get; }

        /// <summary>Red, green, blue, opacity; rows from the top down.</summary>
        public byte[] Pixels { get; }

        /// <summary>Told of every text and of the box around it, for those who check that texts do not meet.</summary>
        public Action<string, Box>? TextDrawn { get; set; }

        public Box Whole => new Box(0.0, 0.0, PixelWidth / Scale, PixelHeight / Scale);

        public Colour this[int pixelX, int pixelY]
        {
            get
            {
                int place = (pixelY * PixelWidth + pixelX) * BytesPerPixel;
                return new Colour(Pixels[place], Pixels[place + 1], Pixels[place + 2], Pixels[place + 3]);
            }
        }

        /// <summary>What is drawn from now on stays within a box; null for the whole picture.</summary>
        public void ClipTo(Box? box)
        {
            Box inside = (box ?? Whole).Snapped(Scale);
            clip = (Math.Max(0, Pixel(inside.Left)), Math.Max(0, Pixel(inside.Top)),
                Math.Min(PixelWidth, Pixel(inside.Right)), Math.Min(PixelHeight, Pixel(inside.Bottom)));
            mask.Clip(clip.Left, clip.Top, clip.Right, clip.Bottom);
        }

        /// <summary>A pixel that the box covers in part gets as much of the colour.</summary>
        public void Fill(Box box, Colour colour)
        {
            double left = box.Left * Scale;
            double top = box.Top * Scale;
            double right = box.Right * Scale;
            double bottom = box.Bottom * Scale;
            int lastX = Math.Min(clip.Right, (int)Math.Ceiling(right));
            int lastY = Math.Min(clip.Bottom, (int)Math.Ceiling(bottom));
            for (int y = Math.Max(clip.Top, (int)Math.Floor(top)); y < lastY; ++y)
            {
                double rows = Math.Min(bottom, y + 1.0) - Math.Max(top, y);
                for (int x = Math.Max(clip.Left, (int)Math.Floor(left)); x < lastX; ++x)
                {
                    double columns = Math.Min(right, x + 1.0) - Math.Max(left, x);
                    Blend(x, y, (float)(rows * columns), colour);
                }
            }
        }

        /// <summary>With round corners and edges between pixels.</summary>
        public void FillRound(Box box, Colour colour, double radius)
        {
            Box sharp = box.Snapped(Scale);
            double round = Math.Ceiling(radius * Scale) / Scale;
            Fill(sharp.Inside(0.0, round, 0.0, round), colour);
            Fill(sharp.Inside(round, 0.0, round, 0.0).Rows(0.0, round), colour);
            Fill(sharp.Inside(round, 0.0, round, 0.0).Rows(sharp.Height - round, round), colour);
            foreach (double x in new[] { sharp.Left + round, sharp.Right - round })
            {
                foreach (double y in new[] { sharp.Top + round, sharp.Bottom - round })
                {
                    FillCorner(sharp, x, y, round, colour);
                }
            }
        }

        /// <summary>A hairline around the inside of a box.</summary>
        public void Outline(Box box, Colour colour)
        {
            double line = 1.0 / Scale;
            Fill(box.Rows(0.0, line), colour);
            Fill(box.Rows(box.Height - line, line), colour);
            Fill(box.Rows(line, box.Height - 2.0 * line).Columns(0.0, line), colour);
            Fill(box.Rows(line, box.Height - 2.0 * line).Columns(box.Width - line, line), colour);
        }

        /// <summary>One pixel wide, sharp.</summary>
        public void HorizontalHair(double left, double right, double y, Colour colour) =>
            Fill(new Box(left, Math.Floor(y * Scale) / Scale, right - left, 1.0 / Scale), colour);

        /// <summary>One pixel wide, sharp.</summary>
        public void VerticalHair(double x, double top, double bottom, Colour colour) =>
            Fill(new Box(Math.Floor(x * Scale) / Scale, top, 1.0 / Scale, bottom - top), colour);

        public void Line(double x0, double y0, double x1, double y1, double width, Colour colour)
        {
            mask.AddLine(x0 * Scale, y0 * Scale, x1 * Scale, y1 * Scale, 0.5 * width * Scale);
            Blend(colour);
        }

        /// <summary>A line through points, of one width.</summary>
        public void Polyline(IReadOnlyList<(double X, double Y)> points, double width, Colour colour)
        {
            for (int index = 1; index < points.Count; ++index)
            {
                mask.AddLine(points[index - 1].X * Scale, points[index - 1].Y * Scale, points[index].X * Scale,
                    points[index].Y * Scale, 0.5 * width * Scale);
            }
            Blend(colour);
        }

        /// <summary>A line with a width of its own for each stretch, without darker joints.</summary>
        public void Stretches(
            IEnumerable<(double X0, double Y0, double X1, double Y1, double Width)> lines, Colour colour)
        {
            foreach ((double x0, double y0, double x1, double y1, double width) in lines)
            {
                mask.AddLine(x0 * Scale, y0 * Scale, x1 * Scale, y1 * Scale, 0.5 * width * Scale);
            }
            Blend(colour);
        }

        public void Disc(double x, double y, double radius, Colour colour) => Line(x, y, x, y, 2.0 * radius, colour);

        /// <param name="y">Of the middle of the capitals.</param>
        /// <param name="size">Points; capitals are 0.7 of it high.</param>
        public void Text(string text, double x, double y, double size, Colour colour,
            TextAlign align = TextAlign.Left, bool bold = false)
        {
            double width = StrokeFont.Width(text, size);
            double left = align == TextAlign.Right ? x - width : align == TextAlign.Centre ? x - 0.5 * width : x;
            StrokeFont.AddTo(mask, text, left * Scale, y * Scale, size * Scale, bold);
            Blend(colour);
            TextDrawn?.Invoke(text, new Box(left, y - 0.45 * size, width, 0.9 * size));
        }

        /// <summary>Sets one pixel of a picture that is computed pixel by pixel.</summary>
        public void SetPixel(int pixelX, int pixelY, Colour colour)
        {
            int place = (pixelY * PixelWidth + pixelX) * BytesPerPixel;
            Pixels[place] = colour.Red;
            Pixels[place + 1] = colour.Green;
            Pixels[place + 2] = colour.Blue;
            Pixels[place + 3] = colour.Opacity;
        }

        /// <summary>Copies another picture of the same scale to a place.</summary>
        public void Paste(PixelCanvas other, double left, double top)
        {
            var toX = (int)Math.Round(left * Scale);
            var toY = (int)Math.Round(top * Scale);
            int count = Math.Min(other.PixelWidth, PixelWidth - toX) * BytesPerPixel;
            for (int row = 0; row < other.PixelHeight && row + toY < PixelHeight; ++row)
            {
                Buffer.BlockCopy(other.Pixels, row * other.PixelWidth * BytesPerPixel, Pixels,
                    ((row + toY) * PixelWidth + toX) * BytesPerPixel, count);
            }
        }

        /// <summary>The pixels with the lowest row first, as textures want them.</summary>
        public byte[] BottomUp()
        {
            var flipped = new byte[Pixels.Length];
            int stride = PixelWidth * BytesPerPixel;
            for (int row = 0; row < PixelHeight; ++row)
            {
                Buffer.BlockCopy(Pixels, row * stride, flipped, (PixelHeight - 1 - row) * stride, stride);
            }
            return flipped;
        }

        /// <summary>Mixes a colour into one pixel.</summary>
        /// <param name="covered">How much of the pixel gets it, 0 to 1.</param>
        internal void Blend(int pixelX, int pixelY, float covered, Colour colour)
        {
            int place = (pixelY * PixelWidth + pixelX) * BytesPerPixel;
            float share = covered * colour.Opacity / 255f;
            if (share > 0.998f || Pixels[place + 3] == 0)
            {
                Pixels[place] = colour.Red;
                Pixels[place + 1] = colour.Green;
                Pixels[place + 2] = colour.Blue;
                Pixels[place + 3] = (byte)(255f * share + 0.5f);
                return;
            }
            Pixels[place] = (byte)(Pixels[place] + share * (colour.Red - Pixels[place]) + 0.5f);
            Pixels[place + 1] = (byte)(Pixels[place + 1] + share * (colour.Green - Pixels[place + 1]) + 0.5f);
            Pixels[place + 2] = (byte)(Pixels[place + 2] + share * (colour.Blue - Pixels[place + 2]) + 0.5f);
            Pixels[place + 3] = (byte)(Pixels[place + 3] + share * (255 - Pixels[place + 3]) + 0.5f);
        }

        /// <summary>The disc around a corner's middle, as far as it lies in the corner.</summary>
        private void FillCorner(Box box, double x, double y, double round, Colour colour)
        {
            (int Left, int Top, int Right, int Bottom) before = clip;
            double left = x < box.MiddleX ? x - round : x;
            double top = y < box.MiddleY ? y - round : y;
            mask.Clip(Math.Max(clip.Left, Pixel(left)), Math.Max(clip.Top, Pixel(top)),
                Math.Min(clip.Right, Pixel(left + round)), Math.Min(clip.Bottom, Pixel(top + round)));
            Disc(x, y, round, colour);
            mask.Clip(before.Left, before.Top, before.Right, before.Bottom);
        }

        private int Pixel(double points) => (int)Math.Round(points * Scale);

        private void Blend(Colour colour) => mask.Drain(this, colour);
    }
}
