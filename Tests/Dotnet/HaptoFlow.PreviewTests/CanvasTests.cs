using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Runtime.InteropServices;
using HaptoFlow.Preview;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using SkiaSharp;

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

    public sealed class AxisNumbersTests
    {
        private readonly CultureInfo culture = CultureInfo.CurrentCulture;

        [TearDown]
        public void Return() => CultureInfo.CurrentCulture = culture;

        [Test]
        public void TicksAreRoundNumbersInTheRange()
        {
            Assert.That(AxisNumbers.Ticks(0.0, 2.7, 6), Is.EqualTo(new[] { 0.0, 0.5, 1.0, 1.5, 2.0, 2.5 }).Within(1e-12));
            Assert.That(AxisNumbers.Ticks(-60.0, 10.0, 4), Is.EqualTo(new[] { -60.0, -40.0, -20.0, 0.0 }).Within(1e-12));
            Assert.That(AxisNumbers.Ticks(0.0, 0.3, 3), Is.EqualTo(new[] { 0.0, 0.1, 0.2, 0.3 }).Within(1e-12));
        }

        [TestCase(0.012, 0.02)]
        [TestCase(0.2, 0.2)]
        [TestCase(7.4, 10.0)]
        [TestCase(3.0, 5.0)]
        [TestCase(0.0, 1.0)]
        [TestCase(double.NaN, 1.0)]
        public void AxisLimitsAreRoundedUpToOneTwoOrFive(double value, double expected) =>
            Assert.That(AxisNumbers.RoundUp(value), Is.EqualTo(expected).Within(1e-12));

        [Test]
        public void NumbersAreTheSameInEveryLocale()
        {
            var comma = (CultureInfo)CultureInfo.InvariantCulture.Clone();
            comma.NumberFormat.NumberDecimalSeparator = ",";
            CultureInfo.CurrentCulture = comma;
            Assert.That(AxisNumbers.Text(-1234.5, 2), Is.EqualTo("\u22121234.5"));
            Assert.That(AxisNumbers.Text(0.25, 1), Is.EqualTo("0.3"));
            Assert.That(AxisNumbers.Fixed(1.0, 2), Is.EqualTo("1.00"));
            Assert.That(AxisNumbers.Fixed(0.12, 2, true), Is.EqualTo("+0.12"));
            Assert.That(AxisNumbers.Fixed(-0.001, 2, true), Is.EqualTo("0.00"), "zero has no sign");
            Assert.That(new LabelMix("wood", "cork", 0.25f).Title, Is.EqualTo("wood 75 % + cork 25 %"));
        }

        [Test]
        public void ABlendWithoutAShareOfTheSecondIsTheFirstAlone()
        {
            Assert.That(new LabelMix("wood", "cork", 0f), Is.EqualTo(new LabelMix("wood")));
            Assert.That(new LabelMix("wood", "", 0.5f), Is.EqualTo(new LabelMix("wood")));
            Assert.That(new LabelMix("wood", "cork", 0.5f), Is.Not.EqualTo(new LabelMix("wood")));
        }
    }

    /// <summary>Draws charts into an image with SkiaSharp. The font is Inter, which is also the editor's.</summary>
    internal sealed class SkiaCanvas : ICanvas, IDisposable
    {
        private const string FontPackage = "fonts-inter";

        private static readonly SKTypeface Regular = Load("Inter-Regular");
        private static readonly SKTypeface Bold = Load("Inter-SemiBold");

        private readonly SKBitmap bitmap;
        private readonly SKCanvas canvas;
        private readonly List<(string Text, Box Ink)> texts = new List<(string, Box)>();

        public SkiaCanvas(double width, double height, double pixelsPerPoint = 1.0, Colour background = default)
        {
            PixelsPerPoint = pixelsPerPoint;
            Whole = new Box(0.0, 0.0, width, height);
            bitmap = new SKBitmap((int)Math.Round(width * pixelsPerPoint), (int)Math.Round(height * pixelsPerPoint),
                SKColorType.Rgba8888, SKAlphaType.Premul);
            canvas = new SKCanvas(bitmap);
            canvas.Clear(ToSkia(background));
            canvas.Scale((float)pixelsPerPoint);
        }

        public double PixelsPerPoint { get; }
        public Box Whole { get; }

        public int PixelHeight => bitmap.Height;

        /// <summary>All texts drawn so far, and the box around the ink of each.</summary>
        public IReadOnlyList<(string Text, Box Ink)> Texts => texts;

        /// <summary>The number of pixels of a box that have a colour.</summary>
        public int Count(Box box, Colour colour) => Count(box, pixel => pixel.Equals(colour));

        public int Count(Box box, Predicate<Colour> matches)
        {
            int count = 0;
            for (var y = (int)(box.Top * PixelsPerPoint); y < (int)(box.Bottom * PixelsPerPoint); ++y)
            {
                for (var x = (int)(box.Left * PixelsPerPoint); x < (int)(box.Right * PixelsPerPoint); ++x)
                {
                    count += matches(this[x, y]) ? 1 : 0;
                }
            }
            return count;
        }

        public Colour this[int pixelX, int pixelY]
        {
            get
            {
                SKColor pixel = bitmap.GetPixel(pixelX, pixelY);
                return new Colour(pixel.Red, pixel.Green, pixel.Blue, pixel.Alpha);
            }
        }

        public void FillRectangle(Box box, Colour colour, double cornerRadius = 0.0)
        {
            using SKPaint paint = Fill(colour);
            canvas.DrawRoundRect(ToSkia(box), (float)cornerRadius, (float)cornerRadius, paint);
        }

        public void DrawPolyline(IReadOnlyList<(double X, double Y)> points, double width, Colour colour)
        {
            using SKPaint paint = Fill(colour);
            paint.Style = SKPaintStyle.Stroke;
            paint.StrokeWidth = (float)width;
            paint.StrokeCap = SKStrokeCap.Round;
            paint.StrokeJoin = SKStrokeJoin.Round;
            using SKPath path = Path(points);
            canvas.DrawPath(path, paint);
        }

        public void FillArea(IReadOnlyList<(double X, double Top, double Bottom)> edges, Colour colour)
        {
            using SKPaint paint = Fill(colour);
            using SKPath path = Path(edges.Select(edge => (edge.X, edge.Top))
                .Concat(edges.Reverse().Select(edge => (edge.X, edge.Bottom))));
            path.Close();
            canvas.DrawPath(path, paint);
        }

        public void DrawText(string text, double x, double y, double size, Colour colour,
            TextAlign align = TextAlign.Left, bool bold = false)
        {
            using SKFont font = Font(size, bold);
            using SKPaint paint = Fill(colour);
            float width = font.MeasureText(text, out SKRect ink);
            double left = align == TextAlign.Right ? x - width : align == TextAlign.Centre ? x - 0.5 * width : x;
            double baseline = y + 0.5 * font.Metrics.CapHeight;
            canvas.DrawText(text, (float)left, (float)baseline, SKTextAlign.Left, font, paint);
            texts.Add((text, new Box(left + ink.Left, baseline + ink.Top, ink.Width, ink.Height)));
        }

        public double MeasureText(string text, double size, bool bold = false)
        {
            using SKFont font = Font(size, bold);
            return font.MeasureText(text);
        }

        public void DrawImage(ColourImage image, Box box)
        {
            using var source = new SKBitmap(image.Width, image.Height, SKColorType.Rgba8888, SKAlphaType.Opaque);
            int stride = image.Width * ColourImage.BytesPerPixel;
            for (int row = 0; row < image.Height; ++row)
            {
                IntPtr place = source.GetAddress(0, image.Height - 1 - row);
                Marshal.Copy(image.Pixels, row * stride, place, stride);
            }
            using SKImage whole = SKImage.FromBitmap(source);
            canvas.DrawImage(whole, ToSkia(box), new SKSamplingOptions(SKFilterMode.Linear));
        }

        public void BeginClip(Box box)
        {
            canvas.Save();
            canvas.ClipRect(ToSkia(box));
        }

        public void EndClip() => canvas.Restore();

        /// <summary>Writes a PNG file.</summary>
        public void Save(string path)
        {
            Directory.CreateDirectory(System.IO.Path.GetDirectoryName(path)!);
            using SKImage image = SKImage.FromBitmap(bitmap);
            using SKData data = image.Encode(SKEncodedImageFormat.Png, 100);
            using FileStream file = File.Create(path);
            data.SaveTo(file);
        }

        public void Dispose()
        {
            canvas.Dispose();
            bitmap.Dispose();
        }

        private static SKTypeface Load(string name)
        {
            string path = "/usr/share/fonts/opentype/inter/" + name + ".otf";
            if (File.Exists(path))
            {
                return SKTypeface.FromFile(path);
            }
            // Without fontconfig, SkiaSharp finds no font of the system on Linux.
            return !RuntimeInformation.IsOSPlatform(OSPlatform.Linux)
                ? SKTypeface.Default
                : throw new FileNotFoundException(
                    $"The charts' font {path} is missing; run: apt-get install {FontPackage}", path);
        }

        private static SKFont Font(double size, bool bold) => new SKFont(bold ? Bold : Regular, (float)size)
        {
            Edging = SKFontEdging.Antialias,
            Subpixel = true,
        };

        private static SKPath Path(IEnumerable<(double X, double Y)> points)
        {
            var path = new SKPath();
            path.AddPoly(points.Select(point => new SKPoint((float)point.X, (float)point.Y)).ToArray(), false);
            return path;
        }

        private static SKPaint Fill(Colour colour) => new SKPaint { Color = ToSkia(colour), IsAntialias = true };

        private static SKColor ToSkia(Colour colour) =>
            new SKColor(colour.Red, colour.Green, colour.Blue, colour.Opacity);

        private static SKRect ToSkia(Box box) =>
            new SKRect((float)box.Left, (float)box.Top, (float)box.Right, (float)box.Bottom);
    }

    /// <summary>Asserts that no text of a picture overlaps another or leaves the picture.</summary>
    internal static class LegibleTexts
    {
        /// <summary>Saves a picture in out/test/preview, for a person to look at, and checks its texts.</summary>
        public static void Save(string name, SkiaCanvas canvas)
        {
            canvas.Save(RepositoryFiles.In("out", "test", "preview", name + ".png"));
            Check(canvas);
        }

        public static void Check(SkiaCanvas canvas)
        {
            IReadOnlyList<(string Text, Box Ink)> texts = canvas.Texts;
            Assert.That(texts, Is.Not.Empty);
            for (int index = 0; index < texts.Count; ++index)
            {
                (string text, Box ink) = texts[index];
                Assert.That(
                    canvas.Whole.Contains(ink.Left, ink.Top) && canvas.Whole.Contains(ink.Right, ink.Bottom),
                    Is.True, $"\"{text}\" leaves the picture");
                foreach ((string other, Box otherInk) in texts.Take(index))
                {
                    Assert.That(Overlap(ink, otherInk), Is.False, $"\"{text}\" overlaps \"{other}\"");
                }
            }
        }

        public static bool Overlap(Box one, Box other) => one.Left < other.Right && other.Left < one.Right &&
            one.Top < other.Bottom && other.Top < one.Bottom;
    }
}
