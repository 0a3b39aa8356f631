#nullable enable
using System;
using System.Collections.Generic;

namespace HaptoFlow.Preview
{
    /// <summary>Text drawn with a round pen, at any size. Letters that <see cref="Glyphs"/> lacks are boxes. Any
    /// thread.</summary>
    internal static class StrokeFont
    {
        // Units of the glyphs: capitals are 7 of a size's 10.
        private const double UnitsPerSize = 10.0;
        private const double CapitalUnits = 7.0;
        private const double Gap = 1.8;
        private const double RegularPen = 1.12;
        private const double BoldPen = 1.62;

        private static readonly object Guard = new object();
        private static readonly Dictionary<char, Glyph> Letters = new Dictionary<char, Glyph>();

        /// <summary>Of a line of text, in the unit of the size.</summary>
        public static double Width(string text, double size)
        {
            double units = 0.0;
            foreach (char letter in text)
            {
                units += Of(letter).Width + Gap;
            }
            return Math.Max(0.0, units - Gap) * size / UnitsPerSize;
        }

        /// <summary>As much of the text as fits, with three dots where some is left out.</summary>
        public static string Fitted(string text, double size, double width)
        {
            if (Width(text, size) <= width)
            {
                return text;
            }
            int kept = text.Length;
            while (kept > 0 && Width(text.Substring(0, kept).TrimEnd() + "\u2026", size) > width)
            {
                --kept;
            }
            return text.Substring(0, kept).TrimEnd() + "\u2026";
        }

        /// <param name="left">Where the first letter begins, in pixels.</param>
        /// <param name="middle">Of the capitals' height, in pixels.</param>
        internal static void AddTo(
            CoverageMask mask, string text, double left, double middle, double sizePixels, bool bold)
        {
            // A pen of about a pixel whose middle runs along the middle of pixels is sharp above and below.
            double capitals = Math.Max(1.0, Math.Round(0.7 * sizePixels));
            double rise = (capitals - 1.0) / CapitalUnits;
            double advance = sizePixels / UnitsPerSize;
            double baseline = Math.Round(middle + 0.5 * capitals) - 0.5;
            double pen = (bold ? BoldPen : RegularPen) * advance;
            double x = left + 0.5 * pen;
            foreach (char each in text)
            {
                Glyph letter = Of(each);
                foreach ((double x0, double y0, double x1, double y1) in letter.Lines)
                {
                    mask.AddLine(
                        x + x0 * advance, baseline - y0 * rise, x + x1 * advance, baseline - y1 * rise, 0.5 * pen);
                }
                x += (letter.Width + Gap) * advance;
            }
        }

        private static Glyph Of(char letter)
        {
            lock (Guard)
            {
                if (!Letters.TryGetValue(letter, out Glyph? made))
                {
                    made = Glyphs.TryFind(letter, out double width, out string path)
                        ? new Glyph(width, path)
                        : new Glyph(3.6, "M0 0L0 7L3.6 7L3.6 0L0 0");
                    Letters[letter] = made;
                }
                return made;
            }
        }
    }
}
