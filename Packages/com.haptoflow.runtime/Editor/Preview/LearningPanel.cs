#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Preview
{
    /// <summary>Draws what was recorded beside what was learnt: a spectrum for each range of speed, the level over speed
    /// for each range of force, kurtosis and ribs. A line is dashed where nothing was recorded.</summary>
    internal static class LearningPanel
    {
        private const double AxisWidth = 36.0;
        private const double Margin = 12.0;
        private const double TitleHeight = 32.0;
        private const double AxisHeight = 20.0;
        private const double FooterHeight = 24.0;
        private const double FiguresWidth = 236.0;
        private const double SpectrumDecibels = 70.0;
        private const double LowestRibDecibels = -40.0;

        // Figures of fewer frames say more about chance than about the material.
        private const int FewestFrames = 8;

        /// <param name="box">As large as <see cref="PreviewLayout.Charts"/> of the smallest window at least.</param>
        public static void Draw(ICanvas canvas, Palette palette, Box box, LearningReport report)
        {
            DrawSpectra(canvas, palette, Spectra(box), report);
            DrawLevels(canvas, palette, box, report);
            DrawKurtosis(canvas, palette, Kurtosis(box), report);
            DrawRibs(canvas, palette, Ribs(box), report);
            string next = report.RecordNext.TrimEnd('.');
            string sentence = next.Length > 0
                ? "To gain most, " + next + "."
                : "Nothing much is missing from the recording.";
            Box footer = box.Rows(box.Height - FooterHeight, FooterHeight);
            canvas.DrawText(canvas.FitText(sentence, Card.TitleSize, footer.Width - 2.0 * Margin), footer.Left + Margin,
                footer.MiddleY + 3.0, Card.TitleSize, palette.Ink);
        }

        public static Box Spectra(Box box) => box.Rows(0.0, Math.Round(0.54 * (box.Height - FooterHeight)));

        public static Box Levels(Box box)
        {
            Box lower = Lower(box);
            return lower.Columns(0.0, lower.Width - FiguresWidth - Card.Gap);
        }

        public static Box Kurtosis(Box box) => Figures(box).Rows(0.0, 0.5 * (Figures(box).Height - Card.Gap));

        public static Box Ribs(Box box)
        {
            Box upper = Kurtosis(box);
            return upper.Rows(upper.Height + Card.Gap, upper.Height);
        }

        /// <summary>The plot area of one range of force within the panel.</summary>
        public static Box LevelPlot(Box box, int index, int count) =>
            Cell(Levels(box).Inside(Margin, TitleHeight, Margin, 6.0), index, count, count);

        private static Box Lower(Box box)
        {
            double top = Spectra(box).Height + Card.Gap;
            return box.Rows(top, box.Height - FooterHeight - top);
        }

        private static Box Figures(Box box)
        {
            Box lower = Lower(box);
            return lower.Columns(lower.Width - FiguresWidth, FiguresWidth);
        }

        /// <summary>The plot area of one of several charts of a card, below its own title.</summary>
        private static Box Cell(Box inside, int index, int count, int columns)
        {
            const double gap = 10.0;
            const double headerHeight = 16.0;
            int rows = (count + columns - 1) / columns;
            double width = (inside.Width - (columns - 1) * gap) / columns;
            double height = inside.Height / rows;
            return new Box(inside.Left + index % columns * (width + gap), inside.Top + index / columns * height, width,
                height).Inside(AxisWidth, headerHeight, 0.0, AxisHeight);
        }

        private static Box Below(ICanvas canvas, Palette palette, Box card, string title, string unit)
        {
            Card.Draw(canvas, palette, card, title, unit, Margin);
            return card.Inside(Margin, TitleHeight, Margin, 6.0);
        }

        private static void Header(ICanvas canvas, Palette palette, Box plot, string text) => canvas.DrawText(
            canvas.FitText(text, Plot.NumberSize, plot.Width), plot.Left, plot.Top - 8.0, Plot.NumberSize, palette.Soft);

        private static void DrawSpectra(ICanvas canvas, Palette palette, Box card, LearningReport report)
        {
            Box inside = Below(canvas, palette, card, "Spectrum", "dB re 1 (m/s\u00b2)\u00b2/Hz");
            DrawLegend(canvas, palette, card, report);
            LearningReport.AtSpeed[] speeds = report.Spectra.Speeds;
            double highest = speeds.SelectMany(each => each.Sides).SelectMany(each => each.Decibels)
                .DefaultIfEmpty(0.0).Max();
            double top = HaptoFlow.Preview.Levels.Top(highest);
            int columns = speeds.Length <= 3 ? speeds.Length : speeds.Length == 4 ? 2 : 3;
            for (int index = 0; index < speeds.Length; ++index)
            {
                LearningReport.AtSpeed speed = speeds[index];
                Box frame = Cell(inside, index, speeds.Length, columns);
                CurveChart chart = CurveChart.OverFrequency(
                    canvas, palette, frame, report.Spectra.FrequenciesHz, (top - SpectrumDecibels, top));
                chart.Rows(AxisNumbers.Ticks(top - SpectrumDecibels, top, 4), value => AxisNumbers.Text(value, 0));
                Header(canvas, palette, frame,
                    Speed(speed.SpeedMps) + " mm/s, " + AxisNumbers.Fixed(speed.Seconds, 1) + " s recorded");
                for (int side = 0; side < speed.Sides.Length; ++side)
                {
                    chart.Line(report.Spectra.FrequenciesHz.Zip(
                            speed.Sides[side].Decibels, (hertz, decibels) => (hertz, decibels)),
                        ColourOf(palette, side));
                }
            }
        }

        private static void DrawLevels(ICanvas canvas, Palette palette, Box box, LearningReport report)
        {
            Below(canvas, palette, Levels(box), "Level", "m/s\u00b2; points and shade: recorded, dashed: extrapolated");
            IReadOnlyList<double> all = report.Levels.Forces
                .SelectMany(force => force.LearntMps2.Concat(force.NearestLabelMps2)).Where(level => level > 0.0).ToArray();
            double low = Math.Floor(Math.Log10(all.DefaultIfEmpty(0.1).Min()));
            double high = Math.Max(low + 1.0, Math.Ceiling(Math.Log10(all.DefaultIfEmpty(10.0).Max())));
            for (int index = 0; index < report.Levels.Forces.Length; ++index)
            {
                LearningReport.AtForce force = report.Levels.Forces[index];
                Box frame = LevelPlot(box, index, report.Levels.Forces.Length);
                CurveChart chart = CurveChart.OverSpeed(canvas, palette, frame, report.Levels.SpeedsMps, (low, high));
                chart.Shade(1000.0 * force.RecordedSpeedMps[0], 1000.0 * force.RecordedSpeedMps[1],
                    palette.Grid.WithOpacity(0.5));
                chart.Rows(AxisNumbers.Ticks(low, high, 6).Where(tick => tick == Math.Floor(tick)),
                    value => AxisNumbers.Text(Math.Pow(10.0, value), 3));
                Header(canvas, palette, frame, AxisNumbers.Fixed(force.ForceNewtons, 1) + " N, " +
                    Speed(force.RecordedSpeedMps[0]) + "\u2013" + Speed(force.RecordedSpeedMps[1]) + " mm/s");
                chart.Line(Law(report, force.NearestLabelMps2, _ => true), palette.Soft);
                chart.Points(force.Speeds.Where(each => each.Recorded.Frames >= FewestFrames && each.Recorded.RmsMps2 > 0.0)
                    .Select(each => (1000.0 * each.SpeedMps, Math.Log10(each.Recorded.RmsMps2))), palette.First);
                (int first, int last) = Recorded(report, force);
                chart.Line(Law(report, force.LearntMps2, place => place <= first), palette.Second, true);
                chart.Line(Law(report, force.LearntMps2, place => place >= last), palette.Second, true);
                chart.Line(Law(report, force.LearntMps2, place => place >= first && place <= last), palette.Second);
            }
        }

        private static void DrawKurtosis(ICanvas canvas, Palette palette, Box card, LearningReport report)
        {
            Box inside = Below(canvas, palette, card, "Kurtosis", "3: even noise");
            double highest = Math.Max(6.0, report.Spectra.Speeds.SelectMany(speed => speed.Sides)
                .Where(each => each.Frames >= FewestFrames).Max(each => each.Kurtosis) ?? 0.0);
            Box frame = inside.Inside(AxisWidth, 0.0, 0.0, AxisHeight);
            CurveChart chart = CurveChart.OverSpeed(canvas, palette, frame, report.Levels.SpeedsMps, (0.0, highest));
            chart.Rows(AxisNumbers.Ticks(0.0, highest, 3), value => AxisNumbers.Text(value, 0));
            DrawFigures(chart, palette, report, figures => figures.Kurtosis, true);
        }

        private static void DrawRibs(ICanvas canvas, Palette palette, Box card, LearningReport report)
        {
            string distances = string.Join(" mm; without points ",
                report.WaveVectors.Select(each => AxisNumbers.Fixed(each.Millimetres, 2)));
            Box inside = Below(canvas, palette, card, "Ribs", distances.Length > 0 ? distances + " mm, dB" : "none found");
            if (distances.Length == 0)
            {
                return;
            }
            Box frame = inside.Inside(AxisWidth, 0.0, 0.0, AxisHeight);
            CurveChart chart = CurveChart.OverSpeed(
                canvas, palette, frame, report.Levels.SpeedsMps, (LowestRibDecibels, 0.0));
            chart.Rows(AxisNumbers.Ticks(LowestRibDecibels, 0.0, 4), value => AxisNumbers.Text(value, 0));
            for (int rib = 0; rib < report.WaveVectors.Length; ++rib)
            {
                int index = rib;
                DrawFigures(chart, palette, report, figures => figures.RibsDb[index], index == 0);
            }
        }

        private static void DrawFigures(
            CurveChart chart, Palette palette, LearningReport report, Func<LearningReport.Figures, double?> figure,
            bool hasPoints)
        {
            for (int side = 0; side < report.Spectra.Speeds[0].Sides.Length; ++side)
            {
                int index = side;
                (double, double)[] values = report.Spectra.Speeds
                    .Select(speed => (speed.SpeedMps, Figures: speed.Sides[index]))
                    .Where(each => each.Figures.Frames >= FewestFrames && figure(each.Figures) != null)
                    .Select(each => (1000.0 * each.SpeedMps, figure(each.Figures)!.Value)).ToArray();
                Colour colour = ColourOf(palette, side);
                chart.Line(values, colour);
                chart.Points(hasPoints ? values : Array.Empty<(double, double)>(), colour);
            }
        }

        /// <summary>From the right edge to the left: learnt, recorded, nearest label.</summary>
        private static void DrawLegend(ICanvas canvas, Palette palette, Box card, LearningReport report)
        {
            double right = card.Right - Margin;
            double y = card.Top + 17.0;
            foreach ((string text, Colour colour) in new[]
                     {
                         ("learnt", palette.Second), ("recorded", palette.First),
                         ("nearest label, " + report.NearestLabel, palette.Soft),
                     })
            {
                canvas.DrawText(text, right, y, Plot.NumberSize, colour, TextAlign.Right, true);
                right -= canvas.MeasureText(text, Plot.NumberSize, true) + 6.0;
                canvas.DrawLine(right - 18.0, y, right, y, 2.0, colour);
                right -= 34.0;
            }
        }

        private static IEnumerable<(double, double)> Law(
            LearningReport report, IReadOnlyList<double> levels, Predicate<int> isDrawn) =>
            Enumerable.Range(0, report.Levels.SpeedsMps.Length).Where(place => isDrawn(place) && levels[place] > 0.0)
                .Select(place => (1000.0 * report.Levels.SpeedsMps[place], Math.Log10(levels[place])));

        /// <summary>The first and the last place of the law within the recorded speeds.</summary>
        private static (int First, int Last) Recorded(LearningReport report, LearningReport.AtForce force)
        {
            int[] within = Enumerable.Range(0, report.Levels.SpeedsMps.Length).Where(place =>
                report.Levels.SpeedsMps[place] >= force.RecordedSpeedMps[0] &&
                report.Levels.SpeedsMps[place] <= force.RecordedSpeedMps[1]).ToArray();
            if (within.Length > 0)
            {
                return (within[0], within[within.Length - 1]);
            }
            // One speed was recorded, between two places.
            int above = report.Levels.SpeedsMps.Count(speed => speed < force.RecordedSpeedMps[0]);
            int place = Math.Min(above, report.Levels.SpeedsMps.Length - 1);
            return (place, place);
        }

        /// <param name="side">Place in <see cref="LearningReport.AtSpeed.Sides"/>.</param>
        private static Colour ColourOf(Palette palette, int side) =>
            side == 0 ? palette.Soft : side == 1 ? palette.First : palette.Second;

        private static string Speed(double mps) => AxisNumbers.Text(1000.0 * mps, 0);
    }
}
