#nullable enable
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Linq;
using System.Threading;
using HaptoFlow.Model;

namespace HaptoFlow.Preview
{
    /// <summary>Draws a table of the tiers: milliseconds per segment on this machine, and accuracy.</summary>
    internal static class QualityTable
    {
        private const double RowHeight = 24.0;
        private const double TextSize = 12.0;
        private const string Unknown = "\u2013";

        /// <param name="chosen">Name of the tier that renders.</param>
        public static void Draw(
            ICanvas canvas, Palette palette, Box box, IReadOnlyList<QualityRow> rows, string chosen)
        {
            double[] columns = Columns(box);
            Headings(canvas, palette, box, columns);
            double slowest = rows.Select(row => row.Timing?.MedianMs ?? 0.0).DefaultIfEmpty().Max();
            for (int index = 0; index < rows.Count; ++index)
            {
                Box row = box.Rows(30.0 + index * RowHeight, RowHeight);
                if (rows[index].Name == chosen)
                {
                    canvas.FillRectangle(row.Inside(-6.0, 1.0, -6.0, 1.0), palette.First.WithOpacity(0.16), 4.0);
                }
                Row(canvas, palette, row, columns, rows[index], slowest);
            }
            Remarks(canvas, palette, box.Rows(38.0 + rows.Count * RowHeight, 60.0), rows);
        }

        /// <summary>Left edges of name and bar, then right edges of the 90th percentile, level error, spectral fit and
        /// spectral distance.</summary>
        private static double[] Columns(Box box)
        {
            double accuracy = box.Right - 164.0;
            return new[] { box.Left, box.Left + 68.0, accuracy - 22.0, accuracy + 44.0, accuracy + 94.0, box.Right };
        }

        private static void Headings(ICanvas canvas, Palette palette, Box box, double[] columns)
        {
            void Heading(string text, double x, TextAlign align, double y) =>
                canvas.DrawText(text, x, box.Top + y, Plot.NumberSize, palette.Soft, align);

            Heading("quality", columns[0], TextAlign.Left, 18.0);
            Heading("ms per segment", columns[1], TextAlign.Left, 6.0);
            Heading("median", columns[1], TextAlign.Left, 18.0);
            Heading("90 %", columns[2], TextAlign.Right, 18.0);
            Heading("level", columns[3], TextAlign.Right, 6.0);
            Heading("error dB", columns[3], TextAlign.Right, 18.0);
            Heading("spectral", columns[4], TextAlign.Right, 6.0);
            Heading("fit", columns[4], TextAlign.Right, 18.0);
            Heading("spectral", columns[5], TextAlign.Right, 6.0);
            Heading("distance dB", columns[5], TextAlign.Right, 18.0);
            canvas.DrawHorizontalHairline(box.Left, box.Right, box.Top + 27.0, palette.Grid);
        }

        private static void Row(
            ICanvas canvas, Palette palette, Box row, double[] columns, QualityRow figures, double slowest)
        {
            void Cell(string text, double x, TextAlign align, Colour colour) =>
                canvas.DrawText(text, x, row.MiddleY, TextSize, colour, align);

            Cell(figures.Name, columns[0], TextAlign.Left, palette.Ink);
            if (figures.Timing is { } timing)
            {
                double room = columns[2] - columns[1] - 84.0;
                double length = Math.Max(2.0, room * timing.MedianMs / slowest);
                var bar = new Box(columns[1], row.MiddleY - 4.0, length, 8.0);
                canvas.FillRectangle(bar, palette.Speed, 2.0);
                Cell(Milliseconds(timing.MedianMs), bar.Right + 7.0, TextAlign.Left, palette.Ink);
                Cell(Milliseconds(timing.Percentile90Ms), columns[2], TextAlign.Right, palette.Soft);
            }
            else
            {
                Cell("not measured yet", columns[1], TextAlign.Left, palette.Soft);
            }
            if (!figures.HasAccuracy)
            {
                Cell("not in the model", columns[5], TextAlign.Right, palette.Soft);
                return;
            }
            Cell(Figure(figures.LevelErrorDecibels, 2, true), columns[3], TextAlign.Right, palette.Ink);
            Cell(Figure(figures.GoodnessOfFit, 3, false), columns[4], TextAlign.Right, palette.Ink);
            Cell(Figure(figures.SpectralDistanceDecibels, 1, false), columns[5], TextAlign.Right, palette.Ink);
        }

        private static void Remarks(ICanvas canvas, Palette palette, Box box, IReadOnlyList<QualityRow> rows)
        {
            int count = rows.Select(row => row.Timing?.Count ?? 0).DefaultIfEmpty().Max();
            string times = count > 0 ? $"Time: this machine, one thread, {count} segments of 100 ms each."
                : "Time: measured on this machine when the first stroke is rendered.";
            string[] lines =
            {
                times,
                "Accuracy: from the model's header.",
                "Level error: generated to recorded RMS, best at 0. Spectral fit: best at 1.",
                "Spectral distance over 20 to 1000 Hz: best at 0.",
            };
            for (int line = 0; line < lines.Length; ++line)
            {
                canvas.DrawText(lines[line], box.Left, box.Top + 7.0 + 15.0 * line, Plot.NumberSize, palette.Soft);
            }
        }

        private static string Milliseconds(double value) => AxisNumbers.Fixed(value, value < 10.0 ? 2 : 1);

        private static string Figure(double? value, int digits, bool signed) =>
            value is { } figure ? AxisNumbers.Fixed(figure, digits, signed) : Unknown;
    }

    /// <summary>The accuracy of a tier by the model's header, null where the header has no value, and its time on this
    /// machine.</summary>
    /// <param name="Timing">Null until it was measured.</param>
    /// <param name="LevelErrorDecibels">Ratio of generated to recorded RMS.</param>
    /// <param name="GoodnessOfFit">GFC of the magnitude spectra, 0 to 1.</param>
    /// <param name="SpectralDistanceDecibels">LSD: RMS over 20 to 1000 Hz of the difference of the mean power
    /// spectra.</param>
    internal sealed record QualityRow(string Name, TierTiming? Timing, double? LevelErrorDecibels, double? GoodnessOfFit,
        double? SpectralDistanceDecibels)
    {
        public bool HasAccuracy =>
            LevelErrorDecibels != null || GoodnessOfFit != null || SpectralDistanceDecibels != null;

        /// <param name="timings">By name of the tier.</param>
        public static IReadOnlyList<QualityRow> Of(
            ModelHeader header, IReadOnlyDictionary<string, TierTiming> timings) => header.Tiers.Select(tier =>
        {
            JsonValue accuracy = JsonValue.Parse(tier.AccuracyJson);
            return new QualityRow(tier.Name, timings.TryGetValue(tier.Name, out TierTiming? timing) ? timing : null,
                accuracy.Find("level_error_db")?.AsNumber(), accuracy.Find("gfc_recording")?.AsNumber(),
                accuracy.Find("lsd_db")?.AsNumber());
        }).ToArray();
    }

    /// <summary>Time that one segment of a tier takes on this machine.</summary>
    internal sealed class TierTiming
    {
        private const int WarmUps = 8;
        private const int Runs = 64;

        private TierTiming(double[] sortedMs)
        {
            Count = sortedMs.Length;
            MedianMs = Percentile(sortedMs, 0.5);
            Percentile90Ms = Percentile(sortedMs, 0.9);
        }

        public int Count { get; }
        public double MedianMs { get; }
        public double Percentile90Ms { get; }

        /// <summary>Generates segments one after the other on the calling thread, the first ones without timing to warm
        /// the caches, as in the benchmarks' column "hot". Takes up to a second.</summary>
        public static TierTiming Measure(HapticGenerator generator, float[] embedding, CancellationToken token)
        {
            var motion = new[] { 0.1f, 0.0f, 1.0f };
            var previous = new float[HapticGenerator.SegmentSamples];
            float[] noise = Noise(new Random(1));
            var segment = new float[HapticGenerator.SegmentSamples];
            var milliseconds = new double[Runs];
            var clock = new Stopwatch();
            for (int run = -WarmUps; run < Runs; ++run)
            {
                token.ThrowIfCancellationRequested();
                clock.Restart();
                generator.Generate(embedding, motion, previous, noise, segment);
                clock.Stop();
                segment.CopyTo(previous, 0);
                if (run >= 0)
                {
                    milliseconds[run] = clock.Elapsed.TotalMilliseconds;
                }
            }
            return Of(milliseconds);
        }

        /// <summary>Standard normal numbers for one segment, by the method of Box and Muller.</summary>
        internal static float[] Noise(Random random)
        {
            var noise = new float[HapticGenerator.SegmentSamples];
            for (int index = 0; index < noise.Length; ++index)
            {
                double size = Math.Sqrt(-2.0 * Math.Log(1.0 - random.NextDouble()));
                noise[index] = (float)(size * Math.Cos(2.0 * Math.PI * random.NextDouble()));
            }
            return noise;
        }

        /// <param name="milliseconds">At least one measurement.</param>
        internal static TierTiming Of(double[] milliseconds) =>
            new TierTiming(milliseconds.OrderBy(value => value).ToArray());

        /// <summary>By the nearest-rank method.</summary>
        private static double Percentile(double[] sorted, double share) =>
            sorted[Math.Max(0, (int)Math.Ceiling(share * sorted.Length) - 1)];
    }
}
