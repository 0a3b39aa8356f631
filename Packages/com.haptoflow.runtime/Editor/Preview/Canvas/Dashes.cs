#nullable enable
using System;
using System.Collections.Generic;

namespace HaptoFlow.Preview
{
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
            bool isDown = true;
            double left = DashPoints;
            for (int index = 1; index < points.Count; ++index)
            {
                (double X, double Y) from = points[index - 1];
                double length = Length(from, points[index]);
                double gone = 0.0;
                if (isDown && dash.Count == 0)
                {
                    dash.Add(from);
                }
                while (length - gone >= left)
                {
                    gone += left;
                    (double X, double Y) turn = Between(from, points[index], gone / length);
                    dash.Add(turn);
                    if (isDown)
                    {
                        canvas.DrawPolyline(dash.ToArray(), width, colour);
                        dash.Clear();
                    }
                    isDown = !isDown;
                    left = isDown ? DashPoints : GapPoints;
                }
                left -= length - gone;
                if (isDown)
                {
                    dash.Add(points[index]);
                }
            }
            if (isDown && dash.Count > 1)
            {
                canvas.DrawPolyline(dash, width, colour);
            }
        }

        private static double Length((double X, double Y) from, (double X, double Y) to) =>
            Math.Sqrt((to.X - from.X) * (to.X - from.X) + (to.Y - from.Y) * (to.Y - from.Y));

        private static (double X, double Y) Between((double X, double Y) from, (double X, double Y) to, double share) =>
            (from.X + share * (to.X - from.X), from.Y + share * (to.Y - from.Y));
    }
}
