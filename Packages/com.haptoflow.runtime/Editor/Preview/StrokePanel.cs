#nullable enable
using System;
using System.Collections.Generic;

namespace HaptoFlow.Preview
{
    /// <summary>Draws the stroke: the patch, and speed and force below it.</summary>
    internal static class StrokePanel
    {
        public static void Draw(ICanvas canvas, Palette palette, Box box, Stroke stroke)
        {
            double y = Card.Draw(canvas, palette, box, "Stroke");
            canvas.DrawText("draw here with mouse or pen", box.Right - 12.0, y, Plot.NumberSize, palette.Soft,
                TextAlign.Right);
            PatchPicture.Draw(canvas, palette, PreviewLayout.Patch(box), stroke, "Draw a stroke");
            Box motion = PreviewLayout.Motion(box);
            canvas.DrawText("speed m/s", motion.Left, motion.Top - 11.0, Plot.NumberSize, palette.Speed, bold: true);
            canvas.DrawText("force N", motion.Right, motion.Top - 11.0, Plot.NumberSize, palette.Force, TextAlign.Right,
                true);
            MotionChart.Draw(canvas, palette, motion, stroke);
        }
    }

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

    /// <summary>Draws speed and force of a stroke over time; both are zero while the tip does not touch.</summary>
    internal static class MotionChart
    {
        /// <param name="frame">The plot area; the axis of speed is left of it, of force right, of time below.</param>
        public static void Draw(ICanvas canvas, Palette palette, Box frame, Stroke stroke)
        {
            double fastest = AxisNumbers.RoundUp(stroke.MaximumSpeedMps);
            double strongest = AxisNumbers.RoundUp(stroke.MaximumForceNewtons);
            var plot = new Plot(canvas, palette, frame, (0.0, stroke.DurationSeconds), (0.0, 1.08));
            IReadOnlyList<double> seconds = AxisNumbers.Ticks(0.0, stroke.DurationSeconds, 5);
            plot.Columns(seconds);
            plot.ColumnTexts(seconds, value => AxisNumbers.Text(value, 2), "s");
            foreach (double share in new[] { 0.0, 0.5, 1.0 })
            {
                double y = plot.Y(share);
                canvas.DrawHorizontalHairline(frame.Left, frame.Right, Math.Min(y, frame.Bottom - 1.0), palette.Grid);
                plot.RowText(AxisNumbers.Text(share * fastest, 4), y, frame.Left - 6.0, TextAlign.Right, palette.Speed);
                plot.RowText(
                    AxisNumbers.Text(share * strongest, 4), y, frame.Right + 6.0, TextAlign.Left, palette.Force);
            }
            List<(double X, double Y)> force = Curve(plot, stroke, state => state.ForceNewtons / strongest);
            canvas.FillArea(force.ConvertAll(point => (point.X, point.Y, plot.Frame.Bottom)),
                palette.Force.WithOpacity(0.22));
            canvas.DrawPolyline(force, 3.0, palette.Force);
            canvas.DrawPolyline(Curve(plot, stroke, state => state.SpeedMps / fastest), 1.6, palette.Speed);
        }

        private static List<(double X, double Y)> Curve(Plot plot, Stroke stroke, Func<StrokeState, double> share)
        {
            var points = new List<(double X, double Y)>();
            foreach (StrokeState state in stroke.States)
            {
                points.Add((plot.X(state.TimeSeconds), plot.Y(state.Touching ? share(state) : 0.0)));
            }
            return points;
        }
    }
}
