#nullable enable
using System;
using System.Collections.Generic;

namespace HaptoFlow.Preview
{
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
