#nullable enable
using System;

namespace HaptoFlow.Preview
{
    /// <summary>How much of each pixel a shape covers. Strokes of one shape do not add up where they overlap, so that
    /// joints of a see-through line are no darker than the line.</summary>
    internal sealed class CoverageMask
    {
        private readonly int width;
        private readonly int height;
        private readonly float[] coverage;
        private (int Left, int Top, int Right, int Bottom) clip;
        private int left;
        private int top;
        private int right;
        private int bottom;

        public CoverageMask(int width, int height)
        {
            this.width = width;
            this.height = height;
            coverage = new float[width * height];
            Clip(0, 0, width, height);
            Forget();
        }

        /// <summary>What is added from now on covers nothing outside of these pixels.</summary>
        public void Clip(int fromX, int fromY, int toX, int toY) =>
            clip = (Math.Max(0, fromX), Math.Max(0, fromY), Math.Min(width, toX), Math.Min(height, toY));

        /// <summary>A line with round ends: the coverage of a pixel is its distance to the line's edge, from half a
        /// pixel inside to half a pixel outside. Pixels, whose middles are at halves.</summary>
        public void AddLine(double x0, double y0, double x1, double y1, double halfWidth)
        {
            double reach = halfWidth + 0.5;
            int fromX = Math.Max(clip.Left, (int)Math.Floor(Math.Min(x0, x1) - reach));
            int toX = Math.Min(clip.Right, (int)Math.Ceiling(Math.Max(x0, x1) + reach));
            int fromY = Math.Max(clip.Top, (int)Math.Floor(Math.Min(y0, y1) - reach));
            int toY = Math.Min(clip.Bottom, (int)Math.Ceiling(Math.Max(y0, y1) + reach));
            if (fromX >= toX || fromY >= toY)
            {
                return;
            }
            Grow(fromX, fromY, toX, toY);
            double alongX = x1 - x0;
            double alongY = y1 - y0;
            double squared = alongX * alongX + alongY * alongY;
            for (int y = fromY; y < toY; ++y)
            {
                for (int x = fromX; x < toX; ++x)
                {
                    double fromStartX = x + 0.5 - x0;
                    double fromStartY = y + 0.5 - y0;
                    double share = squared > 0.0 ? (fromStartX * alongX + fromStartY * alongY) / squared : 0.0;
                    share = share < 0.0 ? 0.0 : share > 1.0 ? 1.0 : share;
                    double offX = fromStartX - share * alongX;
                    double offY = fromStartY - share * alongY;
                    double covered = reach - Math.Sqrt(offX * offX + offY * offY);
                    Raise(x, y, covered);
                }
            }
        }

        /// <summary>Hands every covered pixel to a canvas and is empty afterwards.</summary>
        public void Drain(PixelCanvas canvas, Colour colour)
        {
            for (int y = top; y < bottom; ++y)
            {
                for (int x = left; x < right; ++x)
                {
                    ref float covered = ref coverage[y * width + x];
                    if (covered > 0f)
                    {
                        canvas.Blend(x, y, covered, colour);
                        covered = 0f;
                    }
                }
            }
            Forget();
        }

        private void Raise(int x, int y, double covered)
        {
            ref float pixel = ref coverage[y * width + x];
            if (covered > pixel)
            {
                pixel = covered < 1.0 ? (float)covered : 1f;
            }
        }

        private void Grow(int fromX, int fromY, int toX, int toY)
        {
            left = Math.Min(left, fromX);
            top = Math.Min(top, fromY);
            right = Math.Max(right, toX);
            bottom = Math.Max(bottom, toY);
        }

        private void Forget()
        {
            left = width;
            top = height;
            right = 0;
            bottom = 0;
        }
    }
}
