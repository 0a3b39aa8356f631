#nullable enable
using System;
using System.Collections.Generic;

namespace HaptoFlow.Preview
{
    /// <summary>The relief under a previewed stroke: the map begins at the patch's lower left corner, with its columns
    /// to the right. Immutable; any thread.</summary>
    /// <param name="Name">For messages.</param>
    /// <param name="Heights">Compared by reference.</param>
    /// <param name="Share">How much of the device's range the relief may take.</param>
    internal sealed record PreviewRelief(string Name, ReliefHeights Heights, float Share)
    {
        /// <summary>Where a state lies in the map. A stroke that wraps in the picture goes on in the map.</summary>
        public MapPlace PlaceOf(in StrokeState state) => PlaceOf(state.WayXMetres, state.WayYMetres);

        public MapPlace PlaceOf(double xMetres, double yMetres) =>
            new MapPlace(xMetres / Heights.SizeMetres.Columns, yMetres / Heights.SizeMetres.Rows);
    }

    /// <summary>How high a map is under the tip at each time of a stroke. Immutable; any thread.</summary>
    internal sealed class HeightCurve
    {
        /// <summary>Between two states the tip goes straight, as for the engine.</summary>
        public const int SamplesPerState = 64;

        private readonly float[] millimetres;

        public HeightCurve(Stroke stroke, PreviewRelief relief)
        {
            IReadOnlyList<StrokeState> states = stroke.States;
            DurationSeconds = stroke.DurationSeconds;
            DepthMillimetres = 1000.0 * relief.Heights.DepthMetres;
            millimetres = new float[states.Count * SamplesPerState];
            for (int index = 0; index < states.Count; ++index)
            {
                StrokeState from = states[index];
                // A touch's last state has no next one to go to.
                StrokeState to = index + 1 < states.Count && states[index + 1].Touching ? states[index + 1] : from;
                for (int sample = 0; sample < SamplesPerState; ++sample)
                {
                    double share = sample / (double)SamplesPerState;
                    millimetres[index * SamplesPerState + sample] = from.Touching
                        ? (float)(1000.0 * relief.Heights.MetresAt(relief.PlaceOf(
                            from.WayXMetres + share * (to.WayXMetres - from.WayXMetres),
                            from.WayYMetres + share * (to.WayYMetres - from.WayYMetres))))
                        : float.NaN;
                }
            }
        }

        public double DurationSeconds { get; }

        public double DepthMillimetres { get; }

        /// <summary>The lowest and the highest height in a part of the stroke; false where the tip does not touch in
        /// it.</summary>
        /// <param name="from">As a share of the duration, 0 to 1; so is <paramref name="to"/>.</param>
        public bool TryGetExtremes(double from, double to, out CurvePoint low, out CurvePoint high)
        {
            low = new CurvePoint(0.0, double.PositiveInfinity);
            high = new CurvePoint(0.0, double.NegativeInfinity);
            int first = Math.Max(0, Math.Min(millimetres.Length - 1, (int)(from * millimetres.Length)));
            int end = Math.Min(millimetres.Length, Math.Max(first + 1, (int)Math.Ceiling(to * millimetres.Length)));
            for (int index = first; index < end; ++index)
            {
                // Comparisons with what is not a number are false.
                low = millimetres[index] < low.Millimetres ? PointAt(index) : low;
                high = millimetres[index] > high.Millimetres ? PointAt(index) : high;
            }
            return high.Millimetres >= low.Millimetres;
        }

        private CurvePoint PointAt(int index) =>
            new CurvePoint(DurationSeconds * index / millimetres.Length, millimetres[index]);
    }

    internal readonly struct CurvePoint
    {
        public readonly double Seconds;
        public readonly double Millimetres;

        public CurvePoint(double seconds, double millimetres) => (Seconds, Millimetres) = (seconds, millimetres);
    }

    /// <summary>Draws the height under the tip over time, where the tip touches.</summary>
    internal static class HeightChart
    {
        private const double LineWidth = 1.4;

        /// <param name="frame">The plot area; the axis numbers stand left of it.</param>
        public static void Draw(ICanvas canvas, Palette palette, Box frame, HeightCurve curve)
        {
            var plot = new Plot(
                canvas, palette, frame, (0.0, curve.DurationSeconds), (0.0, 1.05 * curve.DepthMillimetres));
            plot.Columns(AxisNumbers.Ticks(0.0, curve.DurationSeconds, 6));
            plot.Rows(new[] { 0.0, curve.DepthMillimetres }, value => AxisNumbers.Text(value, 2));
            int columns = Math.Max(1, (int)Math.Round(plot.Frame.Width * canvas.PixelsPerPoint));
            var line = new List<(double X, double Y)>();
            for (int column = 0; column < columns; ++column)
            {
                if (curve.TryGetExtremes(
                    column / (double)columns, (column + 1.0) / columns, out CurvePoint low, out CurvePoint high))
                {
                    bool isRising = low.Seconds <= high.Seconds;
                    line.Add(Place(plot, isRising ? low : high));
                    line.Add(Place(plot, isRising ? high : low));
                }
                else
                {
                    DrawTouch(canvas, palette, plot, line);
                    line = new List<(double X, double Y)>();
                }
            }
            DrawTouch(canvas, palette, plot, line);
        }

        private static (double X, double Y) Place(Plot plot, in CurvePoint point) =>
            (plot.X(point.Seconds), plot.Y(point.Millimetres));

        private static void DrawTouch(
            ICanvas canvas, Palette palette, Plot plot, List<(double X, double Y)> line)
        {
            if (line.Count > 0)
            {
                canvas.FillArea(line.ConvertAll(point => (point.X, point.Y, plot.Frame.Bottom)),
                    palette.Speed.WithOpacity(0.22));
                canvas.DrawPolyline(line, LineWidth, palette.Speed);
            }
        }
    }
}
