#nullable enable
using System;
using System.Collections.Generic;

namespace HaptoFlow.Preview
{
    /// <summary>Draws the patch and the stroke on it; the line's width shows the force.</summary>
    internal static class PatchPicture
    {
        private const double MinimumWidthPoints = 1.3;
        private const double MaximumWidthPoints = 5.5;
        private const double WidthStep = 0.25;

        public static (double X, double Y) ToPoints(Box frame, double xMetres, double yMetres) => (
            frame.Left + frame.Width * xMetres / Stroke.PatchWidthMetres,
            frame.Bottom - frame.Height * yMetres / Stroke.PatchHeightMetres);

        public static (double X, double Y) ToMetres(Box frame, double x, double y) => (
            Stroke.PatchWidthMetres * (x - frame.Left) / frame.Width,
            Stroke.PatchHeightMetres * (frame.Bottom - y) / frame.Height);

        /// <param name="hint">Text for a stroke without contact.</param>
        public static void Draw(ICanvas canvas, Palette palette, Box frame, Stroke stroke, string hint)
        {
            canvas.BeginClip(frame);
            canvas.FillRectangle(frame, palette.Patch);
            DrawGrid(canvas, palette, frame);
            DrawPath(canvas, palette, frame, stroke);
            DrawEnds(canvas, palette, frame, stroke);
            if (stroke.MaximumForceNewtons <= 0.0)
            {
                canvas.DrawText(hint, frame.MiddleX, frame.MiddleY, 12.0, palette.Ink, TextAlign.Centre);
            }
            DrawRuler(canvas, palette, frame);
            canvas.EndClip();
        }

        /// <summary>Draws one polyline for each run of segments of the same rounded width.</summary>
        private static void DrawPath(ICanvas canvas, Palette palette, Box frame, Stroke stroke)
        {
            double strongest = Math.Max(1e-6, stroke.MaximumForceNewtons);
            var points = new List<(double X, double Y)>();
            double width = 0.0;
            for (int index = 1; index < stroke.States.Count; ++index)
            {
                StrokeState to = stroke.States[index];
                double share = to.ForceNewtons / strongest;
                double rounded = WidthStep *
                    Math.Round((MinimumWidthPoints + share * (MaximumWidthPoints - MinimumWidthPoints)) / WidthStep);
                if (points.Count > 0 && (!to.Continues || rounded != width))
                {
                    canvas.DrawPolyline(points, width, palette.Ink);
                    points = new List<(double X, double Y)>();
                }
                if (to.Continues)
                {
                    StrokeState from = stroke.States[index - 1];
                    if (points.Count == 0)
                    {
                        points.Add(ToPoints(frame, from.XMetres, from.YMetres));
                    }
                    points.Add(ToPoints(frame, to.XMetres, to.YMetres));
                    width = rounded;
                }
            }
            if (points.Count > 0)
            {
                canvas.DrawPolyline(points, width, palette.Ink);
            }
        }

        /// <summary>Draws a ring at every touch-down, and an arrow head at the end of the last touch.</summary>
        private static void DrawEnds(ICanvas canvas, Palette palette, Box frame, Stroke stroke)
        {
            StrokeState last = default;
            for (int index = 0; index < stroke.States.Count; ++index)
            {
                StrokeState state = stroke.States[index];
                bool touchesDown = state.Touching && (index == 0 || !stroke.States[index - 1].Touching);
                last = state.Touching && state.SpeedMps > 0.0 ? state : last;
                if (touchesDown)
                {
                    (double x, double y) = ToPoints(frame, state.XMetres, state.YMetres);
                    canvas.FillCircle(x, y, 5.5, palette.Ink);
                    canvas.FillCircle(x, y, 3.3, palette.Patch);
                }
            }
            if (last.Touching)
            {
                DrawArrow(canvas, palette, frame, last);
            }
        }

        private static void DrawArrow(ICanvas canvas, Palette palette, Box frame, in StrokeState last)
        {
            (double x, double y) = ToPoints(frame, last.XMetres, last.YMetres);
            double forwardX = last.VelocityXMps / last.SpeedMps;
            double forwardY = -last.VelocityYMps / last.SpeedMps;
            (double X, double Y) tip = (x + 4.0 * forwardX, y + 4.0 * forwardY);
            (double X, double Y) left =
                (tip.X - 10.0 * forwardX - 6.0 * forwardY, tip.Y - 10.0 * forwardY + 6.0 * forwardX);
            (double X, double Y) right =
                (tip.X - 10.0 * forwardX + 6.0 * forwardY, tip.Y - 10.0 * forwardY - 6.0 * forwardX);
            canvas.DrawPolyline(new[] { left, tip, right }, 2.4, palette.Ink);
        }

        private static void DrawGrid(ICanvas canvas, Palette palette, Box frame)
        {
            Colour line = palette.Soft.WithOpacity(0.16);
            for (double metres = 0.01; metres < Stroke.PatchWidthMetres - 1e-6; metres += 0.01)
            {
                canvas.DrawVerticalHairline(ToPoints(frame, metres, 0.0).X, frame.Top, frame.Bottom, line);
            }
            for (double metres = 0.01; metres < Stroke.PatchHeightMetres - 1e-6; metres += 0.01)
            {
                canvas.DrawHorizontalHairline(frame.Left, frame.Right, ToPoints(frame, 0.0, metres).Y, line);
            }
        }

        private static void DrawRuler(ICanvas canvas, Palette palette, Box frame)
        {
            double left = ToPoints(frame, 0.09, 0.0).X;
            double right = ToPoints(frame, 0.11, 0.0).X;
            double y = frame.Bottom - 9.0;
            canvas.DrawLine(left, y, right, y, 1.5, palette.Ink);
            canvas.DrawLine(left, y - 3.0, left, y + 3.0, 1.5, palette.Ink);
            canvas.DrawLine(right, y - 3.0, right, y + 3.0, 1.5, palette.Ink);
            canvas.DrawText("20 mm", 0.5 * (left + right), y - 11.0, Plot.NumberSize, palette.Ink, TextAlign.Centre);
        }
    }
}
