#nullable enable
using System;
using System.Collections.Generic;

namespace HaptoFlow.Preview
{
    /// <summary>The patch with the stroke on it; the line is as thick as the force.</summary>
    internal static class PatchPicture
    {
        private const double ThinnestPoints = 1.3;
        private const double ThickestPoints = 5.5;

        public static (double X, double Y) ToPoints(Box frame, double xMetres, double yMetres) => (
            frame.Left + frame.Width * xMetres / Stroke.PatchWidthMetres,
            frame.Bottom - frame.Height * yMetres / Stroke.PatchHeightMetres);

        public static (double X, double Y) ToMetres(Box frame, double x, double y) => (
            Stroke.PatchWidthMetres * (x - frame.Left) / frame.Width,
            Stroke.PatchHeightMetres * (frame.Bottom - y) / frame.Height);

        /// <param name="hint">Shown where nothing is drawn.</param>
        public static void Draw(PixelCanvas canvas, Palette palette, Box frame, Stroke stroke, string hint)
        {
            canvas.ClipTo(frame);
            canvas.Fill(frame, palette.Patch);
            DrawGrid(canvas, palette, frame);
            double strongest = Math.Max(1e-6, stroke.StrongestNewtons);
            canvas.Stretches(Lines(frame, stroke, strongest), palette.Ink);
            DrawEnds(canvas, palette, frame, stroke);
            if (stroke.StrongestNewtons <= 0.0)
            {
                canvas.Text(hint, frame.MiddleX, frame.MiddleY, 12.0, palette.Ink, TextAlign.Centre);
            }
            DrawRuler(canvas, palette, frame);
            canvas.ClipTo(null);
        }

        private static IEnumerable<(double X0, double Y0, double X1, double Y1, double Width)> Lines(
            Box frame, Stroke stroke, double strongest)
        {
            for (int index = 1; index < stroke.States.Count; ++index)
            {
                StrokeState to = stroke.States[index];
                if (!to.Continues)
                {
                    continue;
                }
                StrokeState from = stroke.States[index - 1];
                (double x0, double y0) = ToPoints(frame, from.XMetres, from.YMetres);
                (double x1, double y1) = ToPoints(frame, to.XMetres, to.YMetres);
                double share = to.ForceNewtons / strongest;
                yield return (x0, y0, x1, y1, ThinnestPoints + share * (ThickestPoints - ThinnestPoints));
            }
        }

        /// <summary>A ring at every touch-down, and an arrow head where the last touch is going.</summary>
        private static void DrawEnds(PixelCanvas canvas, Palette palette, Box frame, Stroke stroke)
        {
            StrokeState last = default;
            for (int index = 0; index < stroke.States.Count; ++index)
            {
                StrokeState state = stroke.States[index];
                bool lands = state.Touching && (index == 0 || !stroke.States[index - 1].Touching);
                last = state.Touching && state.SpeedMps > 0.0 ? state : last;
                if (lands)
                {
                    (double x, double y) = ToPoints(frame, state.XMetres, state.YMetres);
                    canvas.Disc(x, y, 5.5, palette.Ink);
                    canvas.Disc(x, y, 3.3, palette.Patch);
                }
            }
            if (last.Touching)
            {
                DrawArrow(canvas, palette, frame, last);
            }
        }

        private static void DrawArrow(PixelCanvas canvas, Palette palette, Box frame, in StrokeState last)
        {
            (double x, double y) = ToPoints(frame, last.XMetres, last.YMetres);
            double forwardX = last.VelocityXMps / last.SpeedMps;
            double forwardY = -last.VelocityYMps / last.SpeedMps;
            (double X, double Y) tip = (x + 4.0 * forwardX, y + 4.0 * forwardY);
            (double X, double Y) left =
                (tip.X - 10.0 * forwardX - 6.0 * forwardY, tip.Y - 10.0 * forwardY + 6.0 * forwardX);
            (double X, double Y) right =
                (tip.X - 10.0 * forwardX + 6.0 * forwardY, tip.Y - 10.0 * forwardY - 6.0 * forwardX);
            canvas.Polyline(new[] { left, tip, right }, 2.4, palette.Ink);
        }

        private static void DrawGrid(PixelCanvas canvas, Palette palette, Box frame)
        {
            Colour line = palette.Soft.WithOpacity(0.16);
            for (double metres = 0.01; metres < Stroke.PatchWidthMetres - 1e-6; metres += 0.01)
            {
                canvas.VerticalHair(ToPoints(frame, metres, 0.0).X, frame.Top, frame.Bottom, line);
            }
            for (double metres = 0.01; metres < Stroke.PatchHeightMetres - 1e-6; metres += 0.01)
            {
                canvas.HorizontalHair(frame.Left, frame.Right, ToPoints(frame, 0.0, metres).Y, line);
            }
        }

        private static void DrawRuler(PixelCanvas canvas, Palette palette, Box frame)
        {
            double left = ToPoints(frame, 0.09, 0.0).X;
            double right = ToPoints(frame, 0.11, 0.0).X;
            double y = frame.Bottom - 9.0;
            canvas.Line(left, y, right, y, 1.5, palette.Ink);
            canvas.Line(left, y - 3.0, left, y + 3.0, 1.5, palette.Ink);
            canvas.Line(right, y - 3.0, right, y + 3.0, 1.5, palette.Ink);
            canvas.Text("20 mm", 0.5 * (left + right), y - 11.0, Plot.ScaleSize, palette.Ink, TextAlign.Centre);
        }
    }
}
