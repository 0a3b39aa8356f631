#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Preview
{
    /// <summary>The right side of a preview window: waveform and spectrogram of one or two sounds on the same scales,
    /// with the height of a relief under the tip between them, their spectra, and what each quality costs. Images and
    /// scales are computed once, by the constructor, on any thread.</summary>
    internal sealed class SoundPanel
    {
        private const double AxisWidth = 42.0;
        private const double LegendWidth = 56.0;
        private const double HeaderHeight = 34.0;
        private const double Gap = 14.0;
        private const double CardRadius = 5.0;
        private const double TableWidth = 450.0;

        private readonly IReadOnlyList<AnalysedSound> sounds;
        private readonly HeightCurve? heights;
        private readonly ColourImage[] spectrograms;
        private readonly double waveformLimitMps2;
        private readonly double spectrogramTopDecibels;
        private readonly double spectrumTopDecibels;

        /// <param name="sounds">None, one, or two to compare.</param>
        /// <param name="heights">Of the relief under all of them; null without one.</param>
        public SoundPanel(IReadOnlyList<AnalysedSound> sounds, HeightCurve? heights = null)
        {
            this.sounds = sounds;
            this.heights = heights;
            waveformLimitMps2 = WaveformChart.Limit(sounds.Select(each => each.Sound.PeakMps2).DefaultIfEmpty().Max());
            spectrogramTopDecibels = Levels.Top(Highest(sounds.Select(each => (double)each.Spectrogram.Highest)));
            spectrumTopDecibels = Levels.Top(Highest(sounds.Select(each => SpectrumChart.Highest(each.Spectrum))));
            spectrograms = sounds
                .Select(each => SpectrogramChart.Image(each.Spectrogram, spectrogramTopDecibels)).ToArray();
        }

        /// <param name="active">Index of the sound that is played.</param>
        /// <param name="rows">Empty if no model was read.</param>
        /// <param name="chosenTier">Name of the tier that renders.</param>
        public void Draw(ICanvas canvas, Palette palette, Box box, int active, IReadOnlyList<QualityRow> rows,
            string chosenTier)
        {
            Box lower = DrawUpper(canvas, palette, box, active);
            DrawSpectra(canvas, palette, lower.Columns(0.0, lower.Width - TableWidth - Card.Gap));
            DrawTable(canvas, palette, lower.Columns(lower.Width - TableWidth, TableWidth), rows, chosenTier);
        }

        /// <summary>Draws the panel without the table of qualities.</summary>
        /// <param name="active">Index of the sound that is played.</param>
        public void Draw(ICanvas canvas, Palette palette, Box box, int active) =>
            DrawSpectra(canvas, palette, DrawUpper(canvas, palette, box, active));

        /// <summary>The plots of one sound that share an axis of time, from the top: the waveform, the height of a
        /// relief where there is one, the spectrogram.</summary>
        public IReadOnlyList<Box> Plots(Box box, int index) => heights == null
            ? new[] { Waveform(box, index, sounds.Count), SpectrogramBox(box, index, sounds.Count) }
            : new[]
            {
                Waveform(box, index, sounds.Count, true), Heights(box, index, sounds.Count),
                SpectrogramBox(box, index, sounds.Count, true),
            };

        public static Box Waveform(Box box, int index, int count, bool hasHeights = false)
        {
            Box column = Column(box, index, count);
            double height = (hasHeights ? 0.31 : 0.4) * PlotsHeight(box);
            return new Box(column.Left + AxisWidth, column.Top + HeaderHeight, column.Width - AxisWidth, height);
        }

        public static Box Heights(Box box, int index, int count)
        {
            Box waveform = Waveform(box, index, count, true);
            return new Box(waveform.Left, waveform.Bottom + Gap, waveform.Width, 0.17 * PlotsHeight(box));
        }

        public static Box SpectrogramBox(Box box, int index, int count, bool hasHeights = false)
        {
            Box above = hasHeights ? Heights(box, index, count) : Waveform(box, index, count);
            double top = above.Bottom + Gap;
            return new Box(above.Left, top, above.Width, Upper(box).Bottom - 30.0 - top);
        }

        private static double PlotsHeight(Box box) => Upper(box).Height - HeaderHeight - 44.0;

        private static Box Upper(Box box) => box.Rows(0.0, Math.Round(0.63 * box.Height));

        private static Box Column(Box box, int index, int count)
        {
            Box inside = Upper(box).Inside(10.0, 4.0, LegendWidth, 0.0);
            double width = (inside.Width - (count - 1) * Gap) / Math.Max(1, count);
            return inside.Columns(index * (width + Gap), width);
        }

        private static Colour ColourOf(Palette palette, int index) => index == 0 ? palette.First : palette.Second;

        private static double Highest(IEnumerable<double> values) =>
            values.DefaultIfEmpty(double.NegativeInfinity).Max();

        /// <returns>The box below the waveforms and spectrograms.</returns>
        private Box DrawUpper(ICanvas canvas, Palette palette, Box box, int active)
        {
            Box upper = Upper(box);
            canvas.FillRectangle(upper, palette.Card, CardRadius);
            for (int index = 0; index < sounds.Count; ++index)
            {
                IReadOnlyList<Box> plots = Plots(box, index);
                DrawHeader(canvas, palette, Column(box, index, sounds.Count), index, active);
                WaveformChart.Draw(canvas, palette, plots[0], sounds[index].Sound, ColourOf(palette, index),
                    waveformLimitMps2);
                if (heights != null)
                {
                    HeightChart.Draw(canvas, palette, plots[1], heights);
                }
                SpectrogramChart.Draw(canvas, palette, plots[plots.Count - 1], spectrograms[index],
                    sounds[index].Sound.DurationSeconds);
            }
            if (sounds.Count > 0)
            {
                IReadOnlyList<Box> first = Plots(box, 0);
                DrawUnit(canvas, palette, first[0], "m/s\u00b2");
                if (heights != null)
                {
                    DrawUnit(canvas, palette, first[1], "mm");
                }
                DrawUnit(canvas, palette, first[first.Count - 1], "Hz");
                Box last = Plots(box, sounds.Count - 1)[first.Count - 1];
                SpectrogramChart.DrawLegend(canvas, palette,
                    new Box(last.Right + 12.0, last.Top, 9.0, last.Height), spectrogramTopDecibels);
            }
            double used = upper.Height + Card.Gap;
            return box.Rows(used, box.Height - used);
        }

        /// <summary>Title, RMS and peak of a sound; the title of the sound that is played is underlined.</summary>
        private void DrawHeader(ICanvas canvas, Palette palette, Box column, int index, int active)
        {
            const double titleSize = 13.0;
            const double figureSize = 11.0;
            PreviewSound sound = sounds[index].Sound;
            Colour colour = ColourOf(palette, index);
            double y = column.Top + 16.0;
            double left = column.Left + AxisWidth;
            if (sounds.Count > 1)
            {
                canvas.FillRectangle(new Box(left, y - 9.0, 18.0, 18.0), colour, 4.0);
                canvas.DrawText(Name(index), left + 9.0, y, figureSize, palette.Card, TextAlign.Centre, true);
                left += 26.0;
            }
            double width = column.Right - left - 12.0;
            string rms = $"RMS {AxisNumbers.Fixed(sound.RmsMps2, 2)}";
            string figures = $"{rms}   peak {AxisNumbers.Fixed(sound.PeakMps2, 1)} m/s\u00b2";
            double titleWidth = canvas.MeasureText(sound.Title, titleSize, true);
            if (canvas.MeasureText(figures, figureSize) > width - titleWidth)
            {
                figures = rms + " m/s\u00b2";
            }
            string title = canvas.FitText(
                sound.Title, titleSize, width - canvas.MeasureText(figures, figureSize), true);
            canvas.DrawText(title, left, y, titleSize, palette.Ink, bold: true);
            canvas.DrawText(figures, column.Right, y, figureSize, palette.Soft, TextAlign.Right);
            if (sounds.Count > 1 && index == active)
            {
                double end = left + canvas.MeasureText(title, titleSize, true);
                canvas.DrawLine(left, y + 11.0, end, y + 11.0, 2.0, colour);
            }
        }

        /// <summary>Between the first and the second number of an axis.</summary>
        private static void DrawUnit(ICanvas canvas, Palette palette, Box plot, string unit) =>
            canvas.DrawText(unit, plot.Left - 6.0, plot.Top + 16.0, Plot.NumberSize, palette.Soft, TextAlign.Right);

        private void DrawSpectra(ICanvas canvas, Palette palette, Box card)
        {
            double y = Card.Draw(canvas, palette, card, "Spectrum", "dB re 1 (m/s\u00b2)\u00b2/Hz");
            if (sounds.Count == 0)
            {
                return;
            }
            double right = card.Right - 12.0;
            for (int index = sounds.Count - 1; index >= 0 && sounds.Count > 1; --index)
            {
                Colour colour = ColourOf(palette, index);
                canvas.DrawText(Name(index), right, y, 11.0, colour, TextAlign.Right, true);
                canvas.DrawLine(right - 34.0, y, right - 14.0, y, 2.0, colour);
                right -= 50.0;
            }
            SpectrumChart.Draw(canvas, palette, card.Inside(10.0 + AxisWidth, 34.0, 14.0, 26.0), spectrumTopDecibels,
                sounds.Select((each, index) => (each.Spectrum, ColourOf(palette, index))).Reverse().ToArray());
        }

        private static string Name(int index) => index == 0 ? "A" : "B";

        private static void DrawTable(
            ICanvas canvas, Palette palette, Box card, IReadOnlyList<QualityRow> rows, string chosenTier)
        {
            Card.Draw(canvas, palette, card, "What accuracy costs in time", margin: 14.0);
            QualityTable.Draw(canvas, palette, card.Inside(14.0, 38.0, 14.0, 8.0), rows, chosenTier);
        }
    }
}
