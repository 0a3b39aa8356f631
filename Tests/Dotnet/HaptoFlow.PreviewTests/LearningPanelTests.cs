using System;
using System.Linq;
using HaptoFlow.Preview;
using Newtonsoft.Json;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    /// <summary>The curves of recording, learnt material and nearest label.</summary>
    public sealed class LearningPanelTests
    {
        private static SkiaCanvas Panel(Palette palette, Box box, string report, double pixelsPerPoint = 1.0)
        {
            var canvas = new SkiaCanvas(box.Width, box.Height, pixelsPerPoint, palette.Window);
            LearningPanel.Draw(canvas, palette, canvas.Whole, LearningReport.Read(report)!);
            return canvas;
        }

        /// <summary>Share of a plot's columns of pixels that have a colour, between two speeds.</summary>
        private static double Drawn(SkiaCanvas canvas, Box plot, Colour colour, double lowMps, double highMps)
        {
            double Place(double mps) =>
                plot.Left + plot.Width * Math.Log10(mps / 0.005) / Math.Log10(1.0 / 0.005);
            int[] columns = Enumerable.Range((int)Place(lowMps), (int)(Place(highMps) - Place(lowMps))).ToArray();
            return columns.Count(x => Enumerable.Range((int)plot.Top, (int)plot.Height)
                .Any(y => Near(canvas[x, y], colour))) / (double)columns.Length;
        }

        private static bool Near(Colour one, Colour other) => Math.Abs(one.Red - other.Red) < 40 &&
            Math.Abs(one.Green - other.Green) < 40 && Math.Abs(one.Blue - other.Blue) < 40;

        [Test]
        public void TheLearntLevelIsSolidWhereItWasRecordedAndDashedWhereNot([Values] bool dark)
        {
            Palette palette = dark ? Palette.Dark : Palette.Light;
            using SkiaCanvas canvas =
                Panel(palette, new PreviewLayout(1200.0, 700.0, PreviewRoom.WithoutStroke).Charts, MadeReports.Of(6, 2, 1));
            LegibleTexts.Save(dark ? "curves-dark" : "curves-light", canvas);
            for (int force = 0; force < 2; ++force)
            {
                Box plot = LearningPanel.LevelPlot(canvas.Whole, force, 2);
                Assert.That(Drawn(canvas, plot, palette.Second, 0.022, 0.23), Is.GreaterThan(0.95), "recorded");
                Assert.That(Drawn(canvas, plot, palette.Second, 0.0055, 0.018), Is.InRange(0.3, 0.85), "slower");
                Assert.That(Drawn(canvas, plot, palette.Second, 0.28, 0.95), Is.InRange(0.3, 0.85), "faster");
            }
        }

        [Test]
        public void TheSmallestWindowIsLegible(
            [Values(1, 4, 6)] int speeds, [Values(1, 3)] int forces, [Values(0, 2)] int ribs)
        {
            using SkiaCanvas canvas = Panel(Palette.Light,
                new PreviewLayout(0.0, 0.0, PreviewRoom.WithoutStroke).Charts, MadeReports.Of(speeds, forces, ribs));
            LegibleTexts.Save($"curves-smallest-{speeds}-{forces}-{ribs}", canvas);
        }

        [TestCase("record slower strokes, down to 20 mm/s", "To gain most, record slower strokes, down to 20 mm/s.")]
        [TestCase("", "Nothing much is missing from the recording.")]
        public void ASentenceSaysWhatToRecordNext(string next, string sentence)
        {
            using SkiaCanvas canvas = Panel(Palette.Dark,
                new PreviewLayout(0.0, 0.0, PreviewRoom.WithoutStroke).Charts, MadeReports.Of(3, 1, 0, next));
            Assert.That(canvas.Texts.Select(each => each.Text), Does.Contain(sentence));
        }

        [TestCase("")]
        [TestCase("{\"nearest_label\": \"wood\", \"turn_degrees\": 0}")]
        [TestCase("not JSON")]
        public void AReportWithoutCurvesIsNotDrawn(string report) =>
            Assert.That(LearningReport.Read(report)?.HasCurves, Is.Not.True);

        [Test]
        public void UnknownFiguresOfAReportAreRead()
        {
            LearningReport curves = LearningReport.Read(MadeReports.Of(2, 1, 1))!;
            Assert.That(curves.Spectra.Speeds[1].Learnt.RibsDb, Is.EqualTo(new double?[] { -6.1, null }));
            Assert.That(curves.Spectra.Speeds[1].Recorded.Kurtosis, Is.EqualTo(3.4));
            Assert.That(curves.Levels.Forces.Single().RecordedSpeedMps, Is.EqualTo(new[] { 0.02, 0.034 }));
        }
    }

    /// <summary>Reports of learning as the library writes them, with curves of a made surface.</summary>
    internal static class MadeReports
    {
        private static readonly double[] Speeds = { 0.02, 0.034, 0.058, 0.099, 0.17, 0.25 };

        /// <param name="speeds">Number of ranges of speed, 1 to 6.</param>
        /// <param name="forces">Number of ranges of force.</param>
        /// <param name="ribs">Number of wave vectors, 0 to 2.</param>
        public static string Of(int speeds, int forces, int ribs,
            string recordNext = "record faster strokes, up to 300 mm/s: above 250 mm/s the material is a guess")
        {
            double[] frequencies = Enumerable.Range(0, 35).Select(step => 15.625 * Math.Pow(2.0, step / 6.0)).ToArray();
            double[] law = Enumerable.Range(0, 25).Select(step => 0.005 * Math.Pow(200.0, step / 24.0)).ToArray();
            return JsonConvert.SerializeObject(new
            {
                nearest_label = "metal mesh",
                record_next = recordNext,
                wave_vectors = Enumerable.Repeat(new { x_cycles_per_mm = 0.9, y_cycles_per_mm = 0.0 }, ribs),
                spectra = new
                {
                    frequencies_hz = frequencies,
                    speeds = Speeds.Take(speeds).Select(speed => AtSpeed(speed, ribs, frequencies)),
                },
                levels = new
                {
                    speeds_mps = law,
                    forces = Enumerable.Range(1, forces).Select(force => 0.5 * force).Select(newtons => new
                    {
                        force_newtons = newtons,
                        recorded_speed_mps = new[] { Speeds[0], Speeds[speeds - 1] },
                        learnt_mps2 = law.Select(speed => 15.0 * newtons * speed),
                        nearest_label_mps2 = law.Select(speed => 8.0 * newtons * Math.Sqrt(speed)),
                        speeds = Speeds.Take(speeds).Select(speed => AtSpeed(speed, ribs, null, newtons)),
                    }),
                },
            });
        }

        private static object AtSpeed(double speed, int ribs, double[]? frequencies, double gain = 1.0) => new
        {
            speed_mps = speed,
            seconds = 1.7,
            recorded = Figures(gain * speed, 3.4, ribs, frequencies),
            learnt = Figures(1.1 * gain * speed, 3.1, ribs, frequencies),
            nearest_label = Figures(2.0 * gain * speed, 5.0, ribs, frequencies),
        };

        private static object Figures(double speed, double kurtosis, int ribs, double[]? frequencies) => new
        {
            frames = 27,
            rms_mps2 = 15.0 * speed,
            kurtosis,
            ribs_db = new[] { ribs > 0 ? -6.1 : (double?)null, ribs > 1 ? -14.0 : (double?)null },
            decibels = frequencies?.Select(hertz =>
                20.0 * Math.Log10(speed) - 3.0 * Math.Abs(Math.Log(hertz / 180.0, 2.0))),
        };
    }
}
