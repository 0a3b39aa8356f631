using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text;
using System.Text.RegularExpressions;
using System.Threading;
using HaptoFlow.EditorTests;
using HaptoFlow.Model;
using HaptoFlow.Preview;
using HaptoFlow.Tests;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    /// <summary>Draws the charts of the default model into out/test/preview, for a person to look at, and asserts what
    /// can be checked without looking.</summary>
    public sealed class PictureTests
    {
        private static readonly StrokeSettings Usual = new StrokeSettings(0.12, 1.5, 30.0, 2.0);

        private readonly Dictionary<string, IReadOnlyList<AnalysedSound>> rendered =
            new Dictionary<string, IReadOnlyList<AnalysedSound>>();
        private PreviewWorker worker = null!;

        [OneTimeSetUp]
        public void Open() => worker = new PreviewWorker();

        [OneTimeTearDown]
        public void Close() => worker.Dispose();

        private IReadOnlyList<AnalysedSound> Sounds(StrokePreset preset, params LabelMix[] materials)
        {
            string key = preset + string.Join(",", materials.Select(material => material.Title));
            if (!rendered.TryGetValue(key, out IReadOnlyList<AnalysedSound>? sounds))
            {
                var request = new PreviewRequest(ModelFiles.Default, PresetStrokes.Make(preset, Usual), materials)
                {
                    IsSketch = true,
                    Tier = "draft",
                };
                PreviewResult result = worker.Do(request, CancellationToken.None);
                Assert.That(result.Problem, Is.Null);
                rendered[key] = sounds = result.Sounds;
            }
            return sounds;
        }

        private static SkiaCanvas Charts(
            Palette palette, Box box, double pixelsPerPoint, IReadOnlyList<AnalysedSound> sounds)
        {
            var canvas = new SkiaCanvas(box.Width, box.Height, pixelsPerPoint, palette.Window);
            IReadOnlyList<QualityRow> rows = QualityRow.Of(MeasuredModel.Header(), MeasuredModel.Timings());
            new SoundPanel(sounds).Draw(canvas, palette, canvas.Whole, 0, rows, "standard");
            return canvas;
        }

        private static SkiaCanvas Stroke(Palette palette, Stroke stroke, double pixelsPerPoint = 1.0)
        {
            var canvas = new SkiaCanvas(312.0, 340.0, pixelsPerPoint, palette.Window);
            StrokePanel.Draw(canvas, palette, canvas.Whole, stroke);
            return canvas;
        }

        [Test]
        public void TwoMaterialsAreDrawnSideBySideInTheirColours(
            [Values] bool dark, [Values(1.0, 2.0)] double pixelsPerPoint)
        {
            Palette palette = dark ? Palette.Dark : Palette.Light;
            using SkiaCanvas canvas = Charts(palette, new PreviewLayout(1200.0, 800.0).Charts, pixelsPerPoint, Sounds(
                StrokePreset.BackAndForth, new LabelMix("corduroy"), new LabelMix("wood", "sandpaper", 0.3f)));
            LegibleTexts.Save($"charts-two-{(dark ? "dark" : "light")}-{100 * pixelsPerPoint:0}", canvas);
            Box first = SoundPanel.Waveform(canvas.Whole, 0, 2);
            Box second = SoundPanel.Waveform(canvas.Whole, 1, 2);
            Assert.That(canvas.Count(first, palette.First), Is.GreaterThan(1000));
            Assert.That(canvas.Count(second, palette.Second), Is.GreaterThan(1000));
            Assert.That(canvas.Count(first, palette.Second), Is.Zero);
            Assert.That(canvas.Count(second, palette.First), Is.Zero);
        }

        [Test]
        public void TheSmallestWindowIsLegible([Values] bool dark)
        {
            using SkiaCanvas canvas = Charts(dark ? Palette.Dark : Palette.Light, new PreviewLayout(0.0, 0.0).Charts,
                1.0, Sounds(StrokePreset.Taps, new LabelMix("metal mesh", "cardboard", 0.25f),
                    new LabelMix("sandpaper", "metal mesh", 0.5f)));
            LegibleTexts.Save(dark ? "charts-smallest-dark" : "charts-smallest-light", canvas);
        }

        [Test]
        public void TheHeightUnderTheTipIsDrawnBetweenWaveAndSpectrogram([Values] bool dark, [Values(1, 2)] int count)
        {
            Palette palette = dark ? Palette.Dark : Palette.Light;
            var request = new PreviewRequest(ModelFiles.Default, PresetStrokes.Make(StrokePreset.BackAndForth, Usual),
                new[] { new LabelMix("wood"), new LabelMix("stone") }.Take(count).ToArray())
            {
                IsSketch = true, Tier = "draft", Relief = ReliefPreviews.Bricks(),
            };
            PreviewResult result = worker.Do(request, CancellationToken.None);
            Assert.That(result.Problem, Is.Null);
            Box charts = (count == 1 ? new PreviewLayout(1200.0, 940.0) : new PreviewLayout(0.0, 0.0)).Charts;
            using var canvas = new SkiaCanvas(charts.Width, charts.Height, 1.0, palette.Window);
            result.Panel.Draw(canvas, palette, canvas.Whole, 0,
                QualityRow.Of(MeasuredModel.Header(), MeasuredModel.Timings()), "standard");
            LegibleTexts.Save($"charts-relief-{count}-{(dark ? "dark" : "light")}", canvas);
            for (int index = 0; index < count; ++index)
            {
                IReadOnlyList<Box> plots = result.Panel.Plots(canvas.Whole, index);
                Assert.That(plots.Select(plot => (plot.Left, plot.Width)).Distinct().Count(), Is.EqualTo(1),
                    "one axis of time");
                Assert.That(plots[0].Bottom, Is.LessThan(plots[1].Top));
                Assert.That(plots[1].Bottom, Is.LessThan(plots[2].Top));
                Assert.That(canvas.Count(plots[1], palette.Speed), Is.GreaterThan(100));
                Box air = plots[1].Columns(0.0, 0.03 * plots[1].Width);
                Assert.That(canvas.Count(air, palette.Speed), Is.Zero, "before the touch");
            }
            Assert.That(canvas.Texts.Select(each => each.Text), Has.Member("mm").And.Member("1.5"));
        }

        [Test]
        public void ChartsWithoutSoundsHaveTheirTitles()
        {
            using var canvas = new SkiaCanvas(700.0, 500.0, 1.0, Palette.Dark.Window);
            new SoundPanel(Array.Empty<AnalysedSound>()).Draw(
                canvas, Palette.Dark, canvas.Whole, 0, Array.Empty<QualityRow>(), "");
            LegibleTexts.Save("charts-nothing", canvas);
            Assert.That(canvas.Texts.Select(each => each.Text), Does.Contain("Spectrum"));
        }

        [Test]
        public void TheSpectrogramIsBrightWhileTheTipTouches()
        {
            IReadOnlyList<AnalysedSound> sounds = Sounds(
                StrokePreset.BackAndForth, new LabelMix("corduroy"), new LabelMix("wood", "sandpaper", 0.3f));
            using SkiaCanvas canvas = Charts(Palette.Dark, new PreviewLayout(1200.0, 800.0).Charts, 1.0, sounds);
            Box box = SoundPanel.SpectrogramBox(canvas.Whole, 0, 2).Inside(2.0);
            Box air = box.Columns(0.0, 8.0);
            Box touch = box.Columns(0.1 * box.Width, 0.8 * box.Width);
            Assert.That(canvas.Count(air, colour => colour.Red > 60), Is.Zero, "it is dark before the touch");
            Assert.That(canvas.Count(touch, colour => colour.Red > 60), Is.GreaterThan(2000));
        }

        [Test]
        public void EveryStrokeIsDrawnWithItsSpeedAndForce(
            [Values(0, 1, 2, 3, 4, 5)] int preset, [Values] bool dark)
        {
            Palette palette = dark ? Palette.Dark : Palette.Light;
            using SkiaCanvas canvas = Stroke(palette, PresetStrokes.Make((StrokePreset)preset, Usual));
            string name = ((StrokePreset)preset).ToString().ToLowerInvariant();
            LegibleTexts.Save($"stroke-{name}-{(dark ? "dark" : "light")}", canvas);
            Box motion = PreviewLayout.Motion(canvas.Whole);
            Assert.That(canvas.Count(motion, palette.Speed), Is.GreaterThan(60));
            Assert.That(canvas.Count(motion, palette.Force), Is.GreaterThan(60));
            Box patch = PreviewLayout.Patch(canvas.Whole).Inside(0.0, 0.0, 0.0, 30.0);
            Assert.That(canvas.Count(patch, palette.Ink), Is.GreaterThan(100));
        }

        [Test]
        public void AnEmptyPatchShowsAHint()
        {
            using SkiaCanvas canvas = Stroke(Palette.Light, DrawnStroke.Of(Array.Empty<DrawnPoint>()), 2.0);
            LegibleTexts.Save("stroke-empty", canvas);
            Assert.That(canvas.Texts.Select(each => each.Text), Does.Contain("Draw a stroke"));
        }

        [TestCase(1080.0, 932.0)]
        [TestCase(1200.0, 930.0)]
        [TestCase(2500.0, 1400.0)]
        public void ThePartsOfTheWindowDoNotOverlap(double width, double height)
        {
            var layout = new PreviewLayout(width, height);
            Box[] boxes = { layout.Controls, layout.StrokePanel, layout.Charts };
            Box window = new Box(0.0, 0.0, width, height);
            for (int index = 0; index < boxes.Length; ++index)
            {
                Assert.That(window.Contains(boxes[index].Left, boxes[index].Top), Is.True);
                Assert.That(window.Contains(boxes[index].Right, boxes[index].Bottom), Is.True);
                Assert.That(boxes.Take(index).Any(other => LegibleTexts.Overlap(other, boxes[index])), Is.False);
            }
            Assert.That(layout.Controls.Height, Is.GreaterThanOrEqualTo(478.0), "the controls need this height");
        }
    }

    public sealed class QualityRowTests
    {
        private static readonly Dictionary<string, TierTiming> Untimed = new Dictionary<string, TierTiming>();

        [Test]
        public void ARowHasTheAccuracyOfTheHeaderAndTheTimeOfThisMachine()
        {
            ModelHeader header = MeasuredModel.Header();
            IReadOnlyList<QualityRow> rows = QualityRow.Of(header, MeasuredModel.Timings());
            Assert.That(rows.Select(row => row.Name), Is.EqualTo(header.Tiers.Select(tier => tier.Name)));
            Assert.That(rows[0].LevelErrorDecibels, Is.EqualTo(-0.42));
            Assert.That(rows[0].GoodnessOfFit, Is.EqualTo(0.962));
            Assert.That(rows[0].SpectralDistanceDecibels, Is.EqualTo(3.18));
            Assert.That(rows.Single(row => row.Name == "standard").Timing!.MedianMs, Is.EqualTo(0.47));
        }

        [Test]
        public void ValuesMissingInTheHeaderAreNull()
        {
            ModelHeader header = MeasuredModel.HeaderWith(json => MeasuredModel.Figures.Replace(json, "\"accuracy\": {}"));
            QualityRow row = QualityRow.Of(header, Untimed)[0];
            Assert.That(row.HasAccuracy, Is.False);
            Assert.That((row.LevelErrorDecibels, row.GoodnessOfFit, row.Timing),
                Is.EqualTo(((double?)null, (double?)null, (TierTiming?)null)));
        }

        [Test]
        public void PercentilesAreByNearestRank()
        {
            TierTiming timing = TierTiming.Of(Enumerable.Range(1, 10).Select(value => 11.0 - value).ToArray());
            Assert.That((timing.Count, timing.MedianMs, timing.Percentile90Ms), Is.EqualTo((10, 5.0, 9.0)));
        }
    }

    /// <summary>A header with invented accuracy, and invented times.</summary>
    internal static class MeasuredModel
    {
        /// <summary>Matches the accuracy of a tier in a header.</summary>
        public static readonly Regex Figures = new Regex("\"accuracy\":\\s*\\{[^}]*\\}");

        private static readonly string[] Accuracies =
        {
            "{\"level_error_db\": -0.42, \"gfc_recording\": 0.962, \"lsd_db\": 3.18}",
            "{\"level_error_db\": 0.11, \"gfc_recording\": 0.981, \"lsd_db\": 2.27}",
            "{\"level_error_db\": 0.05, \"gfc_recording\": 0.987, \"lsd_db\": 1.94}",
        };

        public static ModelHeader Header() => HeaderWith(json =>
        {
            int tier = 0;
            return Figures.Replace(json, _ => "\"accuracy\": " + Accuracies[tier++]);
        });

        /// <summary>The header of the default model after a change of its text.</summary>
        public static ModelHeader HeaderWith(Func<string, string> change) =>
            ModelHeader.Read(ModelBytes.WithHeader(ModelFiles.Default, change));

        public static Dictionary<string, TierTiming> Timings() => new Dictionary<string, TierTiming>
        {
            ["draft"] = TierTiming.Of(new[] { 0.21, 0.22, 0.29 }),
            ["standard"] = TierTiming.Of(new[] { 0.45, 0.47, 0.58 }),
        };
    }

    internal static class ModelFiles
    {
        public static byte[] Default { get; } = File.ReadAllBytes(RepositoryFiles.DefaultModel);
    }

    /// <summary>Draws clips into out/test/preview, for a person to look at, and asserts what can be checked without
    /// looking.</summary>
    public sealed class ClipChartTests
    {
        [Test]
        public void AClipIsDrawnWithAmplitudeFrequencyAndTransients(
            [Values] bool dark, [Values(300.0, 520.0)] double width, [Values(1.0, 2.0)] double pixelsPerPoint)
        {
            Palette palette = dark ? Palette.Dark : Palette.Light;
            using SkiaCanvas canvas = Draw(Swell(), palette, width, pixelsPerPoint,
                $"clip-{(dark ? "dark" : "light")}-{width:0}-{100 * pixelsPerPoint:0}");
            Box amplitude = ClipChart.Frame(canvas.Whole, 0);
            Box frequency = ClipChart.Frame(canvas.Whole, 1);
            Assert.That(canvas.Count(amplitude, palette.First), Is.GreaterThan(100));
            Assert.That(canvas.Count(frequency, palette.Speed), Is.GreaterThan(60));
            Box pause = frequency.Columns(0.66 * frequency.Width, 0.1 * frequency.Width);
            Assert.That(canvas.Count(pause, palette.Speed), Is.Zero, "no frequency where there is no vibration");
            Box tap = ClipChart.Frame(canvas.Whole, 2).Columns(0.87 * frequency.Width, 0.05 * frequency.Width);
            Assert.That(canvas.Count(tap, palette.First), Is.GreaterThan(10), "a transient is in the vibration");
            Assert.That(canvas.Texts.Select(each => each.Text), Has.Member("Amplitude").And.Member("Frequency, Hz"));
        }

        [TestCase("nothing", "{\"version\":{\"major\":1},\"signals\":{\"continuous\":{\"envelopes\":{\"amplitude\":[{\"time\":0,\"amplitude\":0}]}}}}")]
        [TestCase("long", "{\"version\":{\"major\":1},\"signals\":{\"continuous\":{\"envelopes\":{\"amplitude\":[" +
            "{\"time\":0,\"amplitude\":1},{\"time\":599,\"amplitude\":0}]}}}}")]
        public void AClipOfAnyLengthIsDrawn(string name, string text)
        {
            using HapticClipFile clip = HapticClipFile.Read(Encoding.UTF8.GetBytes(text));
            using SkiaCanvas canvas = Draw(clip, Palette.Dark, 300.0, 1.0, "clip-" + name);
        }

        private static SkiaCanvas Draw(
            HapticClipFile clip, Palette palette, double width, double pixelsPerPoint, string name)
        {
            var canvas = new SkiaCanvas(width, ClipChart.Height, pixelsPerPoint, palette.Window);
            ClipChart.Draw(canvas, palette, canvas.Whole, new ClipCurves(clip));
            LegibleTexts.Save(name, canvas);
            return canvas;
        }

        /// <summary>Swells for 1 s while it rises from 80 to 250 Hz, then taps.</summary>
        private static HapticClipFile Swell()
        {
            var wave = new float[3200];
            double phase = 0.0;
            for (int index = 0; index < 2000; ++index)
            {
                phase += 2.0 * Math.PI * (80.0 + 170.0 * index / 2000.0) / 2000.0;
                wave[index] = (float)(15.0 * Math.Sin(Math.PI * index / 2000.0) * Math.Sin(phase));
            }
            for (int index = 0; index < 20; ++index)
            {
                wave[2850 + index] = (float)(30.0 * Math.Exp(-0.2 * index) * Math.Sin(2.0 * Math.PI * 0.1 * index));
            }
            return HapticClipFile.FromWave(wave, 2000, "swell");
        }
    }
}
