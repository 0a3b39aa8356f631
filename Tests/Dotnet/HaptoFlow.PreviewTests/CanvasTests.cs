using System;
using System.Linq;
using HaptoFlow.Preview;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    public sealed class CanvasTests
    {
        private static readonly Colour White = Colour.Of(0xffffff);
        private static readonly Colour Black = Colour.Of(0x000000);

        [Test]
        public void AHairlineIsOnePixelAtEveryPixelDensity([Values(1.0, 1.25, 2.0)] double pixelsPerPoint)
        {
            using var canvas = new SkiaCanvas(20.0, 20.0, pixelsPerPoint, Black);
            canvas.DrawHorizontalHairline(0.0, 20.0, 7.3, White);
            int[] lit = Enumerable.Range(0, canvas.PixelHeight).Where(y => canvas[3, y].Red > 0).ToArray();
            Assert.That(lit, Is.EqualTo(new[] { (int)(7.3 * pixelsPerPoint) }));
            Assert.That(canvas[3, lit[0]], Is.EqualTo(White));
        }

        [Test]
        public void ATextThatIsTooLongEndsInAnEllipsis()
        {
            using var canvas = new SkiaCanvas(10.0, 10.0);
            double width = canvas.MeasureText("metal mesh", 12.0);
            Assert.That(canvas.FitText("metal mesh", 12.0, width), Is.EqualTo("metal mesh"));
            string fitted = canvas.FitText("metal mesh 40 % + sandpaper 60 %", 12.0, width);
            Assert.That(fitted, Does.StartWith("metal").And.EndsWith("\u2026"));
            Assert.That(canvas.MeasureText(fitted, 12.0), Is.LessThanOrEqualTo(width));
            Assert.That(canvas.FitText("wood", 12.0, 0.0), Is.EqualTo("\u2026"));
        }

        [Test]
        public void ATextIsAlignedHorizontallyAndByTheMiddleOfItsCapitals()
        {
            using var canvas = new SkiaCanvas(300.0, 40.0);
            canvas.DrawText("HIH", 100.0, 20.0, 20.0, White);
            canvas.DrawText("HIH", 100.0, 20.0, 20.0, White, TextAlign.Right);
            canvas.DrawText("HIH", 200.0, 20.0, 20.0, White, TextAlign.Centre);
            Assert.That(canvas.Texts[0].Ink.Left, Is.EqualTo(100.0).Within(3.0));
            Assert.That(canvas.Texts[1].Ink.Right, Is.EqualTo(100.0).Within(3.0));
            Assert.That(canvas.Texts[2].Ink.MiddleX, Is.EqualTo(200.0).Within(1.0));
            Assert.That(canvas.Texts.Select(text => text.Ink.MiddleY), Is.All.EqualTo(20.0).Within(0.6));
        }

        [Test]
        public void TheColourMapGetsLighterAtEveryStep()
        {
            double[] contrasts = Enumerable.Range(0, 101)
                .Select(step => Contrast(ColourMap.At(step / 100.0), Black)).ToArray();
            Assert.That(contrasts, Is.Ordered.Ascending);
            Assert.That(contrasts[^1], Is.GreaterThan(19.0));
            Assert.That(ColourMap.At(double.NaN), Is.EqualTo(ColourMap.At(0.0)));
            Assert.That(ColourMap.At(9.0), Is.EqualTo(ColourMap.At(1.0)));
        }

        [Test]
        public void TextAndCurvesHaveEnoughContrastInBothSkins([Values] bool dark)
        {
            Palette palette = dark ? Palette.Dark : Palette.Light;
            foreach (Colour ground in new[] { palette.Card, palette.Plot, palette.Patch })
            {
                Assert.That(Contrast(palette.Ink, ground), Is.GreaterThan(7.0));
            }
            Assert.That(Contrast(palette.Soft, palette.Card), Is.GreaterThan(4.5));
            foreach (Colour curve in new[] { palette.First, palette.Second, palette.Speed, palette.Force })
            {
                Assert.That(Contrast(curve, palette.Plot), Is.GreaterThan(4.5));
                Assert.That(Contrast(curve, palette.Card), Is.GreaterThan(4.5));
            }
        }

        /// <summary>Contrast ratio of two opaque colours, 1 to 21, as WCAG 2.1 defines it: (L1 + 0.05) / (L2 + 0.05),
        /// where L1 is the relative luminance of the lighter colour.</summary>
        private static double Contrast(Colour one, Colour other)
        {
            (double first, double second) = (Luminance(one), Luminance(other));
            return (Math.Max(first, second) + 0.05) / (Math.Min(first, second) + 0.05);
        }

        private static double Luminance(Colour colour) =>
            0.2126 * Linear(colour.Red) + 0.7152 * Linear(colour.Green) + 0.0722 * Linear(colour.Blue);

        private static double Linear(byte channel)
        {
            double share = channel / 255.0;
            return share <= 0.04045 ? share / 12.92 : Math.Pow((share + 0.055) / 1.055, 2.4);
        }
    }
}
