using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Runtime.InteropServices;
using HaptoFlow.Preview;
using SkiaSharp;

namespace HaptoFlow.PreviewTests
{
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

        public int PixelWidth => bitmap.Width;

        public int PixelHeight => bitmap.Height;

        /// <summary>All texts drawn so far, and the box around the ink of each.</summary>
        public IReadOnlyList<(string Text, Box Ink)> Texts => texts;

        public Colour this[int pixelX, int pixelY]
        {
            get
            {
                SKColor pixel = bitmap.GetPixel(pixelX, pixelY);
                return new Colour(pixel.Red, pixel.Green, pixel.Blue, pixel.Alpha);
            }
        }

        public byte[] Pixels => bitmap.Bytes;

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
}
