using System;
using System.Globalization;
using System.Linq;
using HaptoFlow.Editor;
using HaptoFlow.Preview;

namespace HaptoFlow.PreviewTests
{
    /// <summary>The preview windows in the dark skin, for the documentation. The charts are drawn by the windows' own
    /// code; the controls, which Unity draws, are imitated.</summary>
    internal sealed class WindowPicture
    {
        private const double Tab = 22.0;
        private const double Row = 20.0;
        private const double TextSize = 12.0;
        private const double EntryIndent = 16.0;
        private const double PixelsPerPoint = 1.5;

        private static readonly Palette Palette = Palette.Dark;
        private static readonly Colour Field = Colour.Of(0x2a2a2a);
        private static readonly Colour Button = Colour.Of(0x585858);
        private static readonly Colour Pressed = Colour.Of(0x46607c);
        private static readonly Colour Label = Colour.Of(0xd2d2d2);
        private static readonly Colour Groove = Colour.Of(0x5e5e5e);
        private static readonly Colour Thumb = Colour.Of(0xa0a0a0);

        private readonly SkiaCanvas canvas;
        private readonly Box controls;
        private double y;

        private WindowPicture(SkiaCanvas canvas, Box controls)
        {
            this.canvas = canvas;
            this.controls = controls;
        }

        /// <param name="settings">Settings of the stroke of the result.</param>
        /// <param name="playedSeconds">Position of the playhead.</param>
        public static SkiaCanvas Draw(PreviewResult result, PreviewLayout layout, StrokeSettings settings,
            string preset, double playedSeconds)
        {
            SkiaCanvas canvas = Frame(layout, "Texture Preview");
            StrokePanel.Draw(canvas, Palette, BelowTab(layout.StrokePanel), result.Request.Stroke);
            result.Panel.Draw(canvas, Palette, BelowTab(layout.Charts), result.Request.Active, result.Qualities,
                result.Request.Tier);
            var picture = new WindowPicture(
                canvas, new Box(layout.Controls.Left, layout.Controls.Top + Tab, layout.Controls.Width, 0.0));
            picture.Controls(result, settings, preset);
            picture.Playhead(result, layout, playedSeconds);
            return canvas;
        }

        /// <summary>The New Material window.</summary>
        /// <param name="recording">Description of the recording.</param>
        /// <param name="report">Description of the result.</param>
        /// <param name="drawCharts">Draws the charts in their box.</param>
        public static SkiaCanvas Draw(bool showsCurves, PreviewLayout layout, string name, string licence,
            string recording, string report, Action<ICanvas, Palette, Box> drawCharts)
        {
            SkiaCanvas canvas = Frame(layout, "New Material");
            drawCharts(canvas, Palette, BelowTab(layout.Charts));
            var picture = new WindowPicture(
                canvas, new Box(layout.Controls.Left, layout.Controls.Top + Tab, layout.Controls.Width, 0.0));
            picture.NewMaterial(name, licence, recording, report, showsCurves);
            return canvas;
        }

        private static Box BelowTab(Box box) => new Box(box.Left, box.Top + Tab, box.Width, box.Height);

        private static SkiaCanvas Frame(PreviewLayout layout, string title)
        {
            double width = layout.Charts.Right + layout.Controls.Left;
            double height = layout.Charts.Bottom + layout.Controls.Top;
            var canvas = new SkiaCanvas(width, height + Tab, PixelsPerPoint, Palette.Window);
            canvas.FillRectangle(new Box(0.0, 0.0, width, Tab), Colour.Of(0x282828));
            canvas.FillRectangle(new Box(4.0, 2.0, 128.0, Tab), Palette.Window, 3.0);
            canvas.DrawText(title, 68.0, 12.0, TextSize, Label, TextAlign.Centre);
            canvas.DrawText("Charts drawn by the window's own code in a test; not a screenshot of Unity",
                width - 12.0, 12.0, TextSize, Label, TextAlign.Right);
            return canvas;
        }

        private void Controls(PreviewResult result, StrokeSettings settings, string preset)
        {
            PreviewRequest request = result.Request;
            Choice("Model", "None (Haptic Model Asset)");
            Choice("Material A", request.Materials[0].First);
            Choice("Blend with", "none");
            Tick(Begin("Compare"), request.Materials.Count > 1);
            if (request.Materials.Count > 1)
            {
                LabelMix second = request.Materials[1];
                Choice("Material B", second.First);
                Choice("Blend with", second.Second.Length > 0 ? second.Second : "none");
                if (second.Second.Length > 0)
                {
                    Slider("Share", second.Share, Number(second.Share));
                }
            }
            y += 6.0;
            Choice("Stroke", preset);
            Slider("Speed [m/s]", settings.SpeedMps / TexturePreviewState.MaximumSpeedMps, Number(settings.SpeedMps));
            Slider("Force [N]", settings.ForceNewtons / TexturePreviewState.MaximumForceNewtons,
                Number(settings.ForceNewtons));
            Slider("Direction [\u00b0]", settings.DirectionDegrees / 360.0, Number(settings.DirectionDegrees));
            Slider("Contact [s]", settings.ContactSeconds / TexturePreviewState.MaximumSeconds,
                Number(settings.ContactSeconds));
            Slider("Landing [m/s]", settings.LandingSpeedMps / TexturePreviewState.MaximumLandingMps,
                Number(settings.LandingSpeedMps));
            Effects(request.Effects);
            y += 6.0;
            Choice("Device", request.Device switch
            {
                PreviewDevice.Controller => "Controller (frames)",
                PreviewDevice.Motor => "Motor (160 Hz)",
                _ => "Actuator (waveform)",
            });
            Choice("Quality", request.Tier);
            Box seed = Begin("Seed");
            canvas.FillRectangle(seed, Field, 3.0);
            canvas.DrawText(Number(request.Seed), seed.Left + 6.0, seed.MiddleY, TextSize, Label);
            Choice("Take from", "None (Haptic Material)");
            Buttons(new[] { "Take from Selection", "Apply to Selection" }, new[] { 154.0, 154.0 }, -1);
            y += 6.0;
            Buttons(new[] { "Stop", "A", "B", "Export WAV\u2026", "Measure" },
                new[] { 56.0, 31.0, 31.0, 104.0, 82.0 }, 1 + request.Active);
            Switches(result);
            Words(PreviewKeys.Help);
            Sliders(request);
            Buttons(new[] { "New Material from Recording\u2026" }, new[] { controls.Width }, -1);
        }

        /// <summary>Unfolded if a slider is not at 0.</summary>
        private void Sliders(PreviewRequest request)
        {
            LabelMix material = request.Materials[^1];
            float[] moves = material.Moves.ToArray();
            double middle = controls.Top + y + 9.0;
            double left = controls.Left + 4.0;
            canvas.DrawPolyline(moves.Length > 0
                ? new[] { (left, middle - 2.0), (left + 4.0, middle + 2.0), (left + 8.0, middle - 2.0) }
                : new[] { (left + 2.0, middle - 4.0), (left + 6.0, middle), (left + 2.0, middle + 4.0) }, 1.5, Label);
            canvas.DrawText("Sliders", left + 14.0, middle, TextSize, Label);
            y += Row;
            if (moves.Length > 0)
            {
                Slider("Feature Scale", (material.FeatureScale - 0.25) / 3.75, Number(material.FeatureScale));
                Slider("Tone [dB/oct]", (material.ToneDbPerOctave + 12.0) / 24.0, Number(material.ToneDbPerOctave));
            }
            for (int index = 0; index < moves.Length; ++index)
            {
                MaterialSlider slider = request.Sliders!.Sliders[index];
                Slider(char.ToUpperInvariant(slider.Name[0]) + slider.Name.Substring(1),
                    (moves[index] - slider.Lowest) / (slider.Highest - slider.Lowest),
                    Number(Math.Round(moves[index], 3)));
            }
            if (moves.Length > 0)
            {
                Buttons(new[] { "Reset", "Save as Haptic Material\u2026" }, new[] { 64.0, controls.Width - 66.0 }, -1);
            }
        }

        private void NewMaterial(string name, string licence, string recording, string report, bool showsCurves)
        {
            Choice("Model", "None (Haptic Model Asset)");
            Buttons(new[] { "Choose Recording\u2026" }, new[] { controls.Width }, -1);
            Words(recording);
            Entry("Speed [m/s]", "0");
            Entry("Force [N]", "0");
            Entry("Full Scale [m/s\u00b2]", "0");
            y += 6.0;
            Entry("Name", name);
            Entry("Category", "");
            Entry("Licence", licence);
            Entry("Description", "");
            y += 6.0;
            Buttons(new[] { "Learn" }, new[] { controls.Width }, -1);
            Words(report);
            y += 6.0;
            Buttons(new[] { "Sounds", "Curves" }, new[] { 154.0, 154.0 }, showsCurves ? 1 : 0);
            Buttons(new[] { "Stop", "Recording", "Result" }, new[] { 56.0, 126.0, 126.0 }, 2);
            Box row = new Box(controls.Left, controls.Top + y, controls.Width, Row - 2.0);
            Tick(row, false);
            canvas.DrawText("Loop", row.Left + 20.0, row.MiddleY, TextSize, Label);
            Tick(row.Columns(156.0, 18.0), false);
            canvas.DrawText("Match Levels", row.Left + 176.0, row.MiddleY, TextSize, Label);
            y += Row + 2.0;
            Buttons(new[] { "Save as Haptic Material\u2026" }, new[] { controls.Width }, -1);
            Buttons(new[] { "Export File\u2026" }, new[] { controls.Width }, -1);
        }

        private void Entry(string label, string value)
        {
            Box begun = Begin(label);
            Box field = begun.Columns(EntryIndent, begun.Width - EntryIndent);
            canvas.FillRectangle(field, Field, 3.0);
            canvas.DrawText(value, field.Left + 6.0, field.MiddleY, TextSize, Label);
        }

        private void Buttons(string[] names, double[] widths, int pressed)
        {
            double x = controls.Left;
            for (int index = 0; index < names.Length; ++index)
            {
                var box = new Box(x, controls.Top + y, widths[index], 22.0);
                canvas.FillRectangle(box, index == pressed ? Pressed : Button, 3.0);
                canvas.DrawText(names[index], x + 0.5 * widths[index], controls.Top + y + 11.0, TextSize, Label,
                    TextAlign.Centre);
                x += widths[index] + 2.0;
            }
            y += 24.0;
        }

        private void Switches(PreviewResult result)
        {
            double peak = 0.0;
            foreach (AnalysedSound sound in result.Sounds)
            {
                peak = Math.Max(peak, sound.Sound.Peak);
            }
            Box row = new Box(controls.Left, controls.Top + y, controls.Width, Row - 2.0);
            Tick(row, false);
            canvas.DrawText("Loop", row.Left + 20.0, row.MiddleY, TextSize, Label);
            Tick(row.Columns(66.0, 18.0), true);
            canvas.DrawText("Normalise", row.Left + 86.0, row.MiddleY, TextSize, Label);
            double gain = 20.0 * Math.Log10(PreviewPlayer.RaisedPeak / peak);
            canvas.DrawText(
                AxisNumbers.Text(gain, 0, true) + " dB", row.Left + 160.0, row.MiddleY, Plot.NumberSize, Label);
            y += Row;
        }

        /// <summary>Draws a text, wrapped between words.</summary>
        private void Words(string text)
        {
            string line = "";
            foreach (string word in text.Split(' '))
            {
                string longer = line.Length > 0 ? line + " " + word : word;
                if (canvas.MeasureText(longer, Plot.NumberSize) > controls.Width - 4.0)
                {
                    HelpLine(line);
                    longer = word;
                }
                line = longer;
            }
            HelpLine(line);
        }

        private void HelpLine(string line)
        {
            canvas.DrawText(line, controls.Left + 2.0, controls.Top + y + 6.0, Plot.NumberSize, Palette.Soft);
            y += 13.0;
        }

        private void Tick(Box row, bool on)
        {
            var box = new Box(row.Left + 1.0, row.MiddleY - 7.0, 14.0, 14.0);
            canvas.FillRectangle(box, Field, 2.0);
            if (on)
            {
                canvas.DrawPolyline(new[]
                {
                    (box.Left + 3.0, box.MiddleY), (box.Left + 6.0, box.Bottom - 3.5), (box.Right - 3.0, box.Top + 3.5),
                }, 1.8, Label);
            }
        }

        private void Effects(HapticEffects effects)
        {
            Box row = Begin("Effects");
            double width = row.Width / 3.0;
            double left = row.Left;
            foreach ((HapticEffects effect, string name) in new[]
                     {
                         (HapticEffects.Texture, "Texture"), (HapticEffects.Impact, "Impact"),
                         (HapticEffects.Edge, "Edge"),
                     })
            {
                var box = new Box(left, row.Top, width, row.Height);
                Tick(box, (effects & effect) != 0);
                canvas.DrawText(name, box.Left + 20.0, box.MiddleY, TextSize, Label);
                left += width;
            }
        }

        private void Choice(string label, string value)
        {
            Box field = Begin(label);
            canvas.FillRectangle(field, Button, 3.0);
            canvas.DrawText(value, field.Left + 7.0, field.MiddleY, TextSize, Label);
            canvas.DrawPolyline(new[]
            {
                (field.Right - 16.0, field.MiddleY - 2.0), (field.Right - 12.0, field.MiddleY + 2.0),
                (field.Right - 8.0, field.MiddleY - 2.0),
            }, 1.5, Label);
        }

        private void Slider(string label, double share, string value)
        {
            Box field = Begin(label);
            double length = field.Width - 60.0;
            canvas.FillRectangle(new Box(field.Left, field.MiddleY - 1.0, length, 2.0), Groove, 1.0);
            canvas.FillCircle(field.Left + 5.0 + share * (length - 10.0), field.MiddleY, 5.0, Thumb);
            var number = new Box(field.Right - 54.0, field.Top, 54.0, field.Height);
            canvas.FillRectangle(number, Field, 3.0);
            canvas.DrawText(value, number.Left + 6.0, number.MiddleY, TextSize, Label);
        }

        private Box Begin(string label)
        {
            canvas.DrawText(label, controls.Left + 2.0, controls.Top + y + 9.0, TextSize, Label);
            var field = new Box(controls.Left + 100.0, controls.Top + y, controls.Width - 100.0, Row - 2.0);
            y += Row;
            return field;
        }

        private void Playhead(PreviewResult result, PreviewLayout layout, double seconds)
        {
            int count = result.Sounds.Count;
            Box charts = BelowTab(layout.Charts);
            double share = seconds / result.Sounds[0].Sound.DurationSeconds;
            for (int index = 0; index < count; ++index)
            {
                foreach (Box plot in new[]
                         {
                             SoundPanel.Waveform(charts, index, count), SoundPanel.SpectrogramBox(charts, index, count),
                         })
                {
                    canvas.DrawVerticalHairline(plot.Left + share * plot.Width, plot.Top, plot.Bottom, Palette.Ink);
                }
            }
            StrokeState state = result.Request.Stroke.At(seconds);
            Box patch = PreviewLayout.Patch(BelowTab(layout.StrokePanel));
            (double tipX, double tipY) = PatchPicture.ToPoints(patch, state.XMetres, state.YMetres);
            var tip = new Box(tipX - 4.0, tipY - 4.0, 8.0, 8.0);
            canvas.FillRectangle(tip, Palette.First);
        }

        private static string Number(double value) => value.ToString("0.###", CultureInfo.InvariantCulture);
    }
}
