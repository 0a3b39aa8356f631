#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;

namespace HaptoFlow.Preview
{
    /// <summary>A letter as straight lines, from its path (<see cref="Glyphs"/>).</summary>
    internal sealed class Glyph
    {
        private const int LinesPerTurn = 20;

        private readonly List<(double X0, double Y0, double X1, double Y1)> lines =
            new List<(double, double, double, double)>();
        private readonly string path;
        private int place;
        private double x;
        private double y;

        public Glyph(double width, string path)
        {
            Width = width;
            this.path = path;
            while (place < path.Length)
            {
                Command(path[place++]);
            }
        }

        /// <summary>Without the gap to the next.</summary>
        public double Width { get; }

        public IReadOnlyList<(double X0, double Y0, double X1, double Y1)> Lines => lines;

        private void Command(char command)
        {
            switch (command)
            {
                case 'M':
                    (x, y) = (Number(), Number());
                    break;
                case 'L':
                    To(Number(), Number());
                    break;
                case 'Q':
                    Curve(Number(), Number(), Number(), Number());
                    break;
                case 'A':
                    Arc(Number(), Number(), Number(), Number(), Number(), Number(), true);
                    break;
                default:
                    Arc(Number(), Number(), Number(), Number(), 0.0, 360.0, false);
                    break;
            }
        }

        private void To(double nextX, double nextY)
        {
            lines.Add((x, y, nextX, nextY));
            (x, y) = (nextX, nextY);
        }

        private void Curve(double controlX, double controlY, double endX, double endY)
        {
            (double fromX, double fromY) = (x, y);
            const int parts = LinesPerTurn / 2;
            for (int part = 1; part <= parts; ++part)
            {
                double share = part / (double)parts;
                double rest = 1.0 - share;
                To(rest * rest * fromX + 2.0 * rest * share * controlX + share * share * endX,
                    rest * rest * fromY + 2.0 * rest * share * controlY + share * share * endY);
            }
        }

        private void Arc(double centreX, double centreY, double radiusX, double radiusY, double from, double to,
            bool joined)
        {
            int parts = Math.Max(2, (int)Math.Ceiling(LinesPerTurn * Math.Abs(to - from) / 360.0));
            for (int part = 0; part <= parts; ++part)
            {
                double radians = (from + (to - from) * part / parts) * Math.PI / 180.0;
                double nextX = centreX + radiusX * Math.Cos(radians);
                double nextY = centreY + radiusY * Math.Sin(radians);
                if (part > 0 || joined)
                {
                    To(nextX, nextY);
                }
                (x, y) = (nextX, nextY);
            }
        }

        private double Number()
        {
            while (place < path.Length && path[place] == ' ')
            {
                ++place;
            }
            int begin = place;
            while (place < path.Length && (char.IsDigit(path[place]) || path[place] == '.' || path[place] == '-') &&
                (place == begin || path[place] != '-'))
            {
                ++place;
            }
            return double.Parse(path.AsSpan(begin, place - begin), NumberStyles.Float, CultureInfo.InvariantCulture);
        }
    }
}
