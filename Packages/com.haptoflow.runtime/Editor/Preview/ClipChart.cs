#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Preview
{
    /// <summary>The curves of a clip, ready to be drawn. Immutable; any thread.</summary>
    internal sealed class ClipCurves
    {
        /// <summary>Number of places at which the curves are known, evenly from start to end.</summary>
        public const int Count = 512;

        private const double WaveRateHz = 2000.0;

        /// <exception cref="HaptoFlowException">The clip was disposed.</exception>
        public ClipCurves(HapticClipFile clip)
        {
            DurationSeconds = Math.Max(1e-3, clip.Info.DurationSeconds);
            clip.Curves(Amplitude, FrequencyHz);
            float[] wave = clip.Wave(WaveRateHz);
            for (int place = 0; place < Count && wave.Length > 0; ++place)
            {
                var begin = (int)((long)wave.Length * place / Count);
                int end = Math.Max(begin + 1, (int)((long)wave.Length * (place + 1) / Count));
                ReadOnlySpan<float> samples = wave.AsSpan(begin, end - begin);
                foreach (float sample in samples)
                {
                    LowestMps2[place] = Math.Min(LowestMps2[place], sample);
                    HighestMps2[place] = Math.Max(HighestMps2[place], sample);
                }
            }
        }

        public double DurationSeconds { get; }

        /// <summary>Shares of a device's range, 0 to 1, without the transients.</summary>
        public float[] Amplitude { get; } = new float[Count];

        public float[] FrequencyHz { get; } = new float[Count];

        /// <summary>The lowest values of the vibration around each place, transients included.</summary>
        public float[] LowestMps2 { get; } = new float[Count];

        /// <summary>The highest values of the vibration around each place, transients included.</summary>
        public float[] HighestMps2 { get; } = new float[Count];
    }

    /// <summary>Draws a clip over time: its amplitude, its frequency where it is audible, and the vibration that a voice
    /// plays.</summary>
    internal static class ClipChart
    {
        /// <summary>The height that the chart is made for, in points.</summary>
        public const double Height = 230.0;

        private const int Charts = 3;
        private const double AxisWidth = 34.0;
        private const double HeaderHeight = 18.0;
        private const double FooterHeight = 20.0;
        private const double LineWidth = 1.6;
        private const float LeastAmplitude = 0.02f;
        private const double LeastTopHz = 100.0;

        public static void Draw(ICanvas canvas, Palette palette, Box box, ClipCurves curves)
        {
            canvas.FillRectangle(box, palette.Card, 5.0);
            DrawAmplitude(canvas, palette, Frame(box, 0), curves);
            DrawFrequency(canvas, palette, Frame(box, 1), curves);
            Plot vibration = DrawVibration(canvas, palette, Frame(box, 2), curves);
            vibration.ColumnTexts(Ticks(curves), value => AxisNumbers.Text(value, 3), "s");
        }

        /// <summary>The plot area of a chart: 0 for amplitude, 1 for frequency, 2 for vibration.</summary>
        public static Box Frame(Box box, int chart)
        {
            double height = (box.Height - FooterHeight) / Charts;
            return box.Rows(chart * height, height).Inside(AxisWidth, HeaderHeight, 12.0, 2.0);
        }

        private static void DrawAmplitude(ICanvas canvas, Palette palette, Box frame, ClipCurves curves)
        {
            Plot plot = Begin(canvas, palette, frame, curves, "Amplitude", (0.0, 1.0));
            plot.Rows(new[] { 0.0, 0.5, 1.0 }, value => AxisNumbers.Text(value, 1));
            canvas.FillArea(Places.Select(place => (X(plot, place), plot.Y(curves.Amplitude[place]), plot.Frame.Bottom))
                .ToArray(), Colour.Between(palette.Plot, palette.First, 0.35));
            canvas.DrawPolyline(
                Places.Select(place => (X(plot, place), plot.Y(curves.Amplitude[place]))).ToArray(), LineWidth,
                palette.First);
        }

        private static void DrawFrequency(ICanvas canvas, Palette palette, Box frame, ClipCurves curves)
        {
            int[] audible = Places.Where(place => curves.Amplitude[place] >= LeastAmplitude).ToArray();
            double top = AxisNumbers.RoundUp(
                audible.Select(place => (double)curves.FrequencyHz[place]).Append(LeastTopHz).Max());
            Plot plot = Begin(canvas, palette, frame, curves, "Frequency, Hz", (0.0, top));
            plot.Rows(new[] { 0.0, 0.5 * top, top }, value => AxisNumbers.Text(value, 0));
            var line = new List<(double X, double Y)>();
            foreach (int place in audible)
            {
                if (line.Count > 0 && curves.Amplitude[place - 1] < LeastAmplitude)
                {
                    canvas.DrawPolyline(line, LineWidth, palette.Speed);
                    line.Clear();
                }
                line.Add((X(plot, place), plot.Y(curves.FrequencyHz[place])));
            }
            if (line.Count > 0)
            {
                canvas.DrawPolyline(line, LineWidth, palette.Speed);
            }
        }

        private static Plot DrawVibration(ICanvas canvas, Palette palette, Box frame, ClipCurves curves)
        {
            double limit = WaveformChart.Limit(Math.Max(curves.HighestMps2.Max(), -curves.LowestMps2.Min()));
            Plot plot = Begin(canvas, palette, frame, curves, "Vibration, m/s\u00b2", (-limit, limit));
            plot.Rows(new[] { -limit, 0.0, limit }, value => AxisNumbers.Text(value, 2));
            double pixel = 1.0 / canvas.PixelsPerPoint;
            canvas.FillArea(Places.Select(place =>
            {
                double top = plot.Y(curves.HighestMps2[place]);
                return (X(plot, place), top, Math.Max(top + pixel, plot.Y(curves.LowestMps2[place])));
            }).ToArray(), palette.First);
            return plot;
        }

        private static Plot Begin(ICanvas canvas, Palette palette, Box frame, ClipCurves curves, string title,
            (double Low, double High) vertical)
        {
            canvas.DrawText(title, frame.Left, frame.Top - 9.0, Plot.NumberSize, palette.Ink);
            var plot = new Plot(canvas, palette, frame, (0.0, curves.DurationSeconds), vertical);
            plot.Columns(Ticks(curves));
            return plot;
        }

        private static IEnumerable<int> Places => Enumerable.Range(0, ClipCurves.Count);

        private static double X(Plot plot, int place) =>
            plot.Frame.Left + plot.Frame.Width * place / (ClipCurves.Count - 1.0);

        private static IReadOnlyList<double> Ticks(ClipCurves curves) =>
            AxisNumbers.Ticks(0.0, curves.DurationSeconds, 6);
    }
}
