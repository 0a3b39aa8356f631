#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Preview
{
    /// <summary>The picture of what is heard: a column for each material with waveform and spectrogram on the same
    /// scales, then both spectra, and what quality costs.</summary>
    internal static class SoundPanel
    {
        private const double ScaleWidth = 42.0;
        private const double LegendWidth = 56.0;
        private const double HeaderHeight = 34.0;
        private const double Between = 14.0;
        private const double TableWidth = 450.0;

        /// <param name="sounds">One material, or two to compare.</param>
        /// <param name="active">Which of them is heard.</param>
        /// <param name="rows">Empty where no model was read.</param>
        public static void Draw(PixelCanvas canvas, Palette palette, IReadOnlyList<AnalysedSound> sounds, int active,
            IReadOnlyList<QualityRow> rows, string chosenTier)
        {
            Box lower = DrawUpper(canvas, palette, sounds, active);
            DrawSpectra(canvas, palette, lower.Columns(0.0, lower.Width - TableWidth - 8.0), sounds);
            DrawTable(canvas, palette, lower.Columns(lower.Width - TableWidth, TableWidth), rows, chosenTier);
        }

        /// <summary>Without what quality costs.</summary>
        /// <param name="sounds">One sound, or two to compare.</param>
        /// <param name="active">Which of them is heard.</param>
        public static void Draw(PixelCanvas canvas, Palette palette, IReadOnlyList<AnalysedSound> sounds, int active) =>
            DrawSpectra(canvas, palette, DrawUpper(canvas, palette, sounds, active), sounds);

        /// <returns>The room below.</returns>
        private static Box DrawUpper(
            PixelCanvas canvas, Palette palette, IReadOnlyList<AnalysedSound> sounds, int active)
        {
            Box box = canvas.Whole;
            canvas.Fill(box, palette.Window);
            Box upper = Upper(box);
            Box lower = box.Rows(upper.Bottom + 8.0, box.Height - upper.Bottom - 8.0);
            canvas.FillRound(upper, palette.Card, 5.0);
            double limit = WaveformChart.Limit(sounds.Select(each => each.Sound.PeakMps2).DefaultIfEmpty().Max());
            double top = Levels.Top(Highest(sounds.Select(each => (double)each.Spectrogram.Highest)));
            for (int index = 0; index < sounds.Count; ++index)
            {
                Box column = Column(box, index, sounds.Count);
                Header(canvas, palette, column, sounds, index, active);
                WaveformChart.Draw(canvas, palette, Waveform(box, index, sounds.Count), sounds[index].Sound,
                    ColourOf(palette, index), limit);
                SpectrogramChart.Draw(canvas, palette, SpectrogramBox(box, index, sounds.Count),
                    sounds[index].Spectrogram, sounds[index].Sound.DurationSeconds, top);
            }
            if (sounds.Count > 0)
            {
                Box last = SpectrogramBox(box, sounds.Count - 1, sounds.Count);
                SpectrogramChart.DrawLegend(canvas, palette,
                    new Box(last.Right + 12.0, last.Top, 9.0, last.Height), top);
            }
            return lower;
        }

        /// <summary>The plot of a waveform within the picture.</summary>
        public static Box Waveform(Box box, int index, int count)
        {
            Box column = Column(box, index, count);
            double height = 0.4 * (Upper(box).Height - HeaderHeight - 44.0);
            return new Box(column.Left + ScaleWidth, column.Top + HeaderHeight, column.Width - ScaleWidth, height);
        }

        /// <summary>The plot of a spectrogram within the picture.</summary>
        public static Box SpectrogramBox(Box box, int index, int count)
        {
            Box waveform = Waveform(box, index, count);
            double top = waveform.Bottom + Between;
            return new Box(waveform.Left, top, waveform.Width, Upper(box).Bottom - 30.0 - top);
        }

        private static Box Upper(Box box) => box.Rows(0.0, Math.Round(0.63 * box.Height));

        private static Box Column(Box box, int index, int count)
        {
            Box inside = Upper(box).Inside(10.0, 4.0, LegendWidth, 0.0);
            double width = (inside.Width - (count - 1) * Between) / Math.Max(1, count);
            return inside.Columns(index * (width + Between), width);
        }

        private static Colour ColourOf(Palette palette, int index) => index == 0 ? palette.First : palette.Second;

        private static double Highest(IEnumerable<double> values) =>
            values.DefaultIfEmpty(double.NegativeInfinity).Max();

        private static void Header(PixelCanvas canvas, Palette palette, Box column, IReadOnlyList<AnalysedSound> sounds,
            int index, int active)
        {
            PreviewSound sound = sounds[index].Sound;
            Colour colour = ColourOf(palette, index);
            double y = column.Top + 16.0;
            double left = column.Left + ScaleWidth;
            bool heard = sounds.Count > 1 && index == active;
            if (sounds.Count > 1)
            {
                canvas.FillRound(new Box(left, y - 9.0, 18.0, 18.0), colour, 4.0);
                canvas.Text(index == 0 ? "A" : "B", left + 9.0, y, 11.0, palette.Card, TextAlign.Centre, true);
                left += 26.0;
            }
            double room = column.Right - left - 12.0;
            string figures = Figures(sound, room - StrokeFont.Width(sound.Title, 13.0));
            string title = StrokeFont.Fitted(sound.Title, 13.0, room - StrokeFont.Width(figures, 11.0));
            canvas.Text(title, left, y, 13.0, palette.Ink, bold: true);
            canvas.Text(figures, column.Right, y, 11.0, palette.Soft, TextAlign.Right);
            if (heard)
            {
                double end = left + StrokeFont.Width(title, 13.0);
                canvas.Line(left, y + 11.0, end, y + 11.0, 2.0, colour);
            }
            if (index == 0)
            {
                Box waveform = Waveform(canvas.Whole, 0, sounds.Count);
                Box spectrogram = SpectrogramBox(canvas.Whole, 0, sounds.Count);
                Unit(canvas, palette, waveform, "m/s\u00b2");
                Unit(canvas, palette, spectrogram, "Hz");
            }
        }

        /// <summary>With the peak where there is room for it.</summary>
        private static string Figures(PreviewSound sound, double room)
        {
            string rms = $"RMS {Scale.Fixed(sound.RmsMps2, 2)}";
            string both = $"{rms}   peak {Scale.Fixed(sound.PeakMps2, 1)} m/s\u00b2";
            return StrokeFont.Width(both, 11.0) <= room ? both : rms + " m/s\u00b2";
        }

        /// <summary>In the gap between the first and the second number of a scale.</summary>
        private static void Unit(PixelCanvas canvas, Palette palette, Box plot, string unit) =>
            canvas.Text(unit, plot.Left - 6.0, plot.Top + 16.0, Plot.ScaleSize, palette.Soft, TextAlign.Right);

        private static void DrawSpectra(
            PixelCanvas canvas, Palette palette, Box card, IReadOnlyList<AnalysedSound> sounds)
        {
            canvas.FillRound(card, palette.Card, 5.0);
            double y = card.Top + 17.0;
            canvas.Text("Spectrum", card.Left + 12.0, y, 12.0, palette.Ink, bold: true);
            canvas.Text("dB re 1 (m/s\u00b2)\u00b2/Hz", card.Left + 84.0, y, Plot.ScaleSize, palette.Soft);
            if (sounds.Count == 0)
            {
                return;
            }
            double right = card.Right - 12.0;
            for (int index = sounds.Count - 1; index >= 0 && sounds.Count > 1; --index)
            {
                Colour colour = ColourOf(palette, index);
                canvas.Text(index == 0 ? "A" : "B", right, y, 11.0, colour, TextAlign.Right, true);
                canvas.Line(right - 34.0, y, right - 14.0, y, 2.0, colour);
                right -= 50.0;
            }
            double top = Levels.Top(Highest(sounds.Select(each => SpectrumChart.Highest(each.Spectrum))));
            SpectrumChart.Draw(canvas, palette, card.Inside(10.0 + ScaleWidth, 34.0, 14.0, 26.0), top,
                sounds.Select((each, index) => (each.Spectrum, ColourOf(palette, index))).Reverse().ToArray());
        }

        private static void DrawTable(
            PixelCanvas canvas, Palette palette, Box card, IReadOnlyList<QualityRow> rows, string chosenTier)
        {
            canvas.FillRound(card, palette.Card, 5.0);
            canvas.Text("What accuracy costs in time", card.Left + 14.0, card.Top + 17.0, 12.0, palette.Ink,
                bold: true);
            QualityTable.Draw(canvas, palette, card.Inside(14.0, 38.0, 14.0, 8.0), rows, chosenTier);
        }
    }
}
