using System.Linq;
using HaptoFlow.Preview;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    /// <summary>The curves of recording, learnt material and nearest label.</summary>
    public sealed class LearningPanelTests
    {
        private static SkiaCanvas Panel(Palette palette, Box box, string report, double pixelsPerPoint = 1.0)
        {
            var canvas = new SkiaCanvas(box.Width, box.Height, pixelsPerPoint, palette.Window);
            LearningPanel.Draw(canvas, palette, canvas.Whole, LearningReport.Read(report)!.Curves!);
            return canvas;
        }

        private static void Save(string name, SkiaCanvas canvas)
        {
            canvas.Save(RepositoryFiles.In("out", "test", "preview", name + ".png"));
            LegibleTexts.Check(canvas);
        }

        /// <summary>Share of a plot's columns of pixels that have a colour, between two speeds.</summary>
        private static double Drawn(SkiaCanvas canvas, Box plot, Colour colour, double lowMps, double highMps)
        {
            double Place(double mps) =>
                plot.Left + plot.Width * System.Math.Log10(mps / 0.005) / System.Math.Log10(1.0 / 0.005);
            int[] columns = Enumerable.Range((int)Place(lowMps), (int)(Place(highMps) - Place(lowMps))).ToArray();
            return columns.Count(x => Enumerable.Range((int)plot.Top, (int)plot.Height)
                .Any(y => Near(canvas[x, y], colour))) / (double)columns.Length;
        }

        private static bool Near(Colour one, Colour other) => System.Math.Abs(one.Red - other.Red) < 40 &&
            System.Math.Abs(one.Green - other.Green) < 40 && System.Math.Abs(one.Blue - other.Blue) < 40;

        [Test]
        public void TheLearntLevelIsSolidWhereItWasRecordedAndDashedWhereNot([Values] bool dark)
        {
            Palette palette = dark ? Palette.Dark : Palette.Light;
            using SkiaCanvas canvas =
                Panel(palette, new PreviewLayout(1200.0, 700.0, PreviewRoom.WithoutStroke).Charts, MadeReports.Of(6, 2, 1));
            Save(dark ? "curves-dark" : "curves-light", canvas);
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
            Save($"curves-smallest-{speeds}-{forces}-{ribs}", canvas);
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
            Assert.That(LearningReport.Read(report)?.Curves, Is.Null);

        [Test]
        public void UnknownFiguresOfAReportAreRead()
        {
            LearningCurves curves = LearningReport.Read(MadeReports.Of(2, 1, 1))!.Curves!;
            Assert.That(curves.Spectra.Speeds[1].Learnt.RibsDb, Is.EqualTo(new double?[] { -6.1, null }));
            Assert.That(curves.Spectra.Speeds[1].Recorded.Kurtosis, Is.EqualTo(3.4));
            Assert.That(curves.Levels.Forces.Single().RecordedSpeedMps, Is.EqualTo(new[] { 0.02, 0.034 }));
        }
    }
}
