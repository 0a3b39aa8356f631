using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Preview;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    public sealed class DrawingTests
    {
        private const string Letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789" +
            ".,:;!?'\"-\u2212\u2013+\u00b1\u00d7\u00b7=<>/\\|_()[]%#*&\u00b0\u00b2\u00b5\u2026";

        private static readonly Colour White = Colour.Of(0xffffff);
        private static readonly Colour Black = Colour.Of(0x000000);

        private static PixelCanvas BlackCanvas(double width, double height, double scale = 1.0)
        {
            var canvas = new PixelCanvas(width, height, scale);
            canvas.Fill(canvas.Whole, Black);
            return canvas;
        }

        /// <summary>Sum of the light of all pixels, in whole pixels.</summary>
        private static double Light(PixelCanvas canvas) =>
            Enumerable.Range(0, canvas.PixelWidth * canvas.PixelHeight)
                .Sum(index => canvas[index % canvas.PixelWidth, index / canvas.PixelWidth].Red / 255.0);

        [Test]
        public void ABoxCoversItsAreaOnWholeAndOnBrokenPixels([Values(1.0, 1.5, 2.0)] double scale)
        {
            PixelCanvas canvas = BlackCanvas(40.0, 40.0, scale);
            canvas.Fill(new Box(4.25, 6.5, 20.5, 10.25), White);
            Assert.That(Light(canvas), Is.EqualTo(20.5 * 10.25 * scale * scale).Within(0.02 * 210.0 * scale * scale));
        }

        [Test]
        public void ADiscCoversItsArea()
        {
            PixelCanvas canvas = BlackCanvas(40.0, 40.0);
            canvas.Disc(20.3, 19.8, 9.0, White);
            Assert.That(Light(canvas), Is.EqualTo(Math.PI * 81.0).Within(3.0));
        }

        [Test]
        public void ALineThroughPointsIsNoBrighterAtItsJoints()
        {
            PixelCanvas canvas = BlackCanvas(40.0, 20.0);
            canvas.Polyline(new[] { (5.0, 10.0), (20.0, 10.0), (35.0, 10.0) }, 4.0, White.WithOpacity(0.5));
            Assert.That(canvas[20, 10], Is.EqualTo(canvas[12, 10]));
            Assert.That((int)canvas[20, 10].Red, Is.EqualTo(128).Within(1));
        }

        [Test]
        public void AHairlineIsOnePixelHoweverDenseTheScreen([Values(1.0, 1.25, 2.0)] double scale)
        {
            PixelCanvas canvas = BlackCanvas(20.0, 20.0, scale);
            canvas.HorizontalHair(0.0, 20.0, 7.3, White);
            int[] lit = Enumerable.Range(0, canvas.PixelHeight).Where(y => canvas[3, y].Red > 0).ToArray();
            Assert.That(lit, Is.EqualTo(new[] { (int)(7.3 * scale) }));
            Assert.That(canvas[3, lit[0]], Is.EqualTo(White));
        }

        [Test]
        public void DrawingBesideThePictureLeavesItAsItIs()
        {
            PixelCanvas canvas = BlackCanvas(10.0, 10.0);
            canvas.Fill(new Box(-20.0, -20.0, 10.0, 10.0), White);
            canvas.Line(50.0, 50.0, 60.0, 70.0, 3.0, White);
            canvas.Text("far away", 100.0, 100.0, 12.0, White);
            Assert.That(Light(canvas), Is.Zero);
            canvas.Line(-5.0, 5.0, 15.0, 5.0, 2.0, White);
            Assert.That(Light(canvas), Is.EqualTo(20.0).Within(0.1));
        }

        [Test]
        public void EveryLetterHasInkOfItsOwnWithinItsWidth()
        {
            var seen = new HashSet<string>();
            foreach (char letter in Letters)
            {
                PixelCanvas canvas = BlackCanvas(80.0, 80.0);
                canvas.Text(letter.ToString(), 20.0, 40.0, 40.0, White);
                double width = StrokeFont.Width(letter.ToString(), 40.0);
                int[] columns = Enumerable.Range(0, 80)
                    .Where(x => Enumerable.Range(0, 80).Any(y => canvas[x, y].Red > 127)).ToArray();
                Assert.That(columns, Is.Not.Empty, letter.ToString());
                Assert.That(columns[0], Is.GreaterThanOrEqualTo(19), letter.ToString());
                Assert.That(columns[^1], Is.LessThan(20.0 + width + 8.0), letter.ToString());
                Assert.That(seen.Add(Convert.ToBase64String(canvas.Pixels)), Is.True, $"{letter} looks like another");
            }
        }

        [Test]
        public void ALetterThatNobodyDrewIsABox()
        {
            PixelCanvas unknown = BlackCanvas(40.0, 40.0);
            unknown.Text("\u6728", 5.0, 20.0, 30.0, White);
            PixelCanvas other = BlackCanvas(40.0, 40.0);
            other.Text("\u7af9", 5.0, 20.0, 30.0, White);
            Assert.That(Light(unknown), Is.GreaterThan(50.0));
            Assert.That(unknown.Pixels, Is.EqualTo(other.Pixels));
        }

        [Test]
        public void AlignedTextEndsOrCentresAtItsPlace()
        {
            (int First, int Last) Ink(TextAlign align)
            {
                PixelCanvas canvas = BlackCanvas(200.0, 30.0);
                canvas.Text("HIH", 100.0, 15.0, 20.0, White, align);
                int[] columns = Enumerable.Range(0, 200).Where(x => canvas[x, 15].Red > 60).ToArray();
                return (columns[0], columns[^1]);
            }

            Assert.That(Ink(TextAlign.Left).First, Is.EqualTo(100).Within(1));
            Assert.That(Ink(TextAlign.Right).Last, Is.EqualTo(100).Within(2));
            (int first, int last) = Ink(TextAlign.Centre);
            Assert.That(0.5 * (first + last), Is.EqualTo(100.0).Within(1.5));
        }

        [Test]
        public void CapitalsAreSharpAboveAndBelow()
        {
            PixelCanvas canvas = BlackCanvas(60.0, 40.0);
            canvas.Text("EFT", 10.0, 20.4, 12.0, White);
            int[] rows = Enumerable.Range(0, 40)
                .Where(y => Enumerable.Range(0, 60).Any(x => canvas[x, y].Red > 60)).ToArray();
            Assert.That(rows.Length, Is.EqualTo(8), "0.7 of a size of 12");
        }

        [Test]
        public void ATextThatIsTooLongEndsInThreeDots()
        {
            double room = StrokeFont.Width("metal mesh", 12.0);
            Assert.That(StrokeFont.Fitted("metal mesh", 12.0, room), Is.EqualTo("metal mesh"));
            string cut = StrokeFont.Fitted("metal mesh 40 % + sandpaper 60 %", 12.0, room);
            Assert.That(cut, Does.StartWith("metal").And.EndsWith("\u2026"));
            Assert.That(StrokeFont.Width(cut, 12.0), Is.LessThanOrEqualTo(room));
            Assert.That(StrokeFont.Fitted("wood", 12.0, 0.0), Is.EqualTo("\u2026"));
        }

        [Test]
        public void TexturesGetTheLowestRowFirst()
        {
            PixelCanvas canvas = BlackCanvas(3.0, 2.0);
            canvas.SetPixel(1, 0, White);
            byte[] flipped = canvas.BottomUp();
            Assert.That(flipped.Skip(4 * (3 + 1)).Take(4), Is.EqualTo(new byte[] { 255, 255, 255, 255 }));
            Assert.That(flipped.Take(12).Where((_, index) => index % 4 != 3), Is.All.Zero);
        }

        [Test]
        public void APictureIsPastedWhereItIsAskedForAndCutAtTheEdge()
        {
            PixelCanvas canvas = BlackCanvas(10.0, 10.0, 2.0);
            var stamp = new PixelCanvas(4.0, 4.0, 2.0);
            stamp.Fill(stamp.Whole, White);
            canvas.Paste(stamp, 8.0, 1.0);
            Assert.That(Light(canvas), Is.EqualTo(2.0 * 4.0 * 4.0));
            Assert.That(canvas[16, 2], Is.EqualTo(White));
        }

        [Test]
        public void TheColourMapOnlyGetsLighter()
        {
            double[] contrasts = Enumerable.Range(0, 101)
                .Select(step => Colour.Contrast(ColourMap.At(step / 100.0), Black)).ToArray();
            Assert.That(contrasts, Is.Ordered.Ascending);
            Assert.That(contrasts[^1], Is.GreaterThan(19.0));
            Assert.That(ColourMap.At(double.NaN), Is.EqualTo(ColourMap.At(0.0)));
            Assert.That(ColourMap.At(9.0), Is.EqualTo(ColourMap.At(1.0)));
        }

        [Test]
        public void TextAndCurvesStandOutInBothSkins([Values] bool dark)
        {
            Palette palette = dark ? Palette.Dark : Palette.Light;
            foreach (Colour ground in new[] { palette.Card, palette.Plot, palette.Patch })
            {
                Assert.That(Colour.Contrast(palette.Ink, ground), Is.GreaterThan(7.0));
            }
            Assert.That(Colour.Contrast(palette.Soft, palette.Card), Is.GreaterThan(4.5));
            foreach (Colour curve in new[] { palette.First, palette.Second, palette.Speed, palette.Force })
            {
                Assert.That(Colour.Contrast(curve, palette.Plot), Is.GreaterThan(4.5));
                Assert.That(Colour.Contrast(curve, palette.Card), Is.GreaterThan(4.5));
            }
        }

        [Test]
        public void ContrastIsThatOfTheGuidelines()
        {
            Assert.That(Colour.Contrast(White, Black), Is.EqualTo(21.0).Within(1e-9));
            Assert.That(Colour.Contrast(Colour.Of(0x777777), White), Is.EqualTo(4.478).Within(0.001));
        }
    }
}
