using System;
using System.Linq;
using System.Text;
using HaptoFlow.Preview;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
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
            Assert.That(Count(canvas, amplitude, palette.First), Is.GreaterThan(100));
            Assert.That(Count(canvas, frequency, palette.Speed), Is.GreaterThan(60));
            Box pause = frequency.Columns(0.66 * frequency.Width, 0.1 * frequency.Width);
            Assert.That(Count(canvas, pause, palette.Speed), Is.Zero, "no frequency where there is no vibration");
            Box tap = ClipChart.Frame(canvas.Whole, 2).Columns(0.87 * frequency.Width, 0.05 * frequency.Width);
            Assert.That(Count(canvas, tap, palette.First), Is.GreaterThan(10), "a transient is in the vibration");
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
            canvas.Save(RepositoryFiles.In("out", "test", "preview", name + ".png"));
            LegibleTexts.Check(canvas);
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

        private static int Count(SkiaCanvas canvas, Box box, Colour colour)
        {
            int count = 0;
            double density = canvas.PixelsPerPoint;
            for (var y = (int)(box.Top * density); y < (int)(box.Bottom * density); ++y)
            {
                for (var x = (int)(box.Left * density); x < (int)(box.Right * density); ++x)
                {
                    count += canvas[x, y].Equals(colour) ? 1 : 0;
                }
            }
            return count;
        }
    }
}
