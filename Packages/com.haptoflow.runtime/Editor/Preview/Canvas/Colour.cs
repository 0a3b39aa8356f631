#nullable enable
using System;

namespace HaptoFlow.Preview
{
    /// <summary>An sRGB colour with opacity, each channel from 0 to 255.</summary>
    internal readonly struct Colour : IEquatable<Colour>
    {
        public Colour(byte red, byte green, byte blue, byte opacity = 255) =>
            (Red, Green, Blue, Opacity) = (red, green, blue, opacity);

        public byte Red { get; }

        public byte Green { get; }

        public byte Blue { get; }

        public byte Opacity { get; }

        /// <param name="rgb">0xRRGGBB, opaque.</param>
        public static Colour Of(int rgb) => new Colour((byte)(rgb >> 16), (byte)(rgb >> 8), (byte)rgb);

        /// <param name="share">0 to 1.</param>
        public Colour WithOpacity(double share) =>
            new Colour(Red, Green, Blue, (byte)Math.Round(255.0 * Math.Max(0.0, Math.Min(1.0, share))));

        /// <param name="share">0 gives the first colour, 1 the second.</param>
        public static Colour Between(Colour first, Colour second, double share) => new Colour(
            Mix(first.Red, second.Red, share), Mix(first.Green, second.Green, share),
            Mix(first.Blue, second.Blue, share), Mix(first.Opacity, second.Opacity, share));

        /// <summary>Contrast ratio of two opaque colours, 1 to 21, as WCAG 2.1 defines it: (L1 + 0.05) / (L2 + 0.05),
        /// where L1 is the relative luminance of the lighter colour.</summary>
        public static double Contrast(Colour one, Colour other)
        {
            double light = Math.Max(one.Luminance, other.Luminance);
            double dark = Math.Min(one.Luminance, other.Luminance);
            return (light + 0.05) / (dark + 0.05);
        }

        public bool Equals(Colour other) =>
            Red == other.Red && Green == other.Green && Blue == other.Blue && Opacity == other.Opacity;

        public override bool Equals(object? other) => other is Colour colour && Equals(colour);

        public override int GetHashCode() => HashCode.Combine(Red, Green, Blue, Opacity);

        private double Luminance => 0.2126 * Linear(Red) + 0.7152 * Linear(Green) + 0.0722 * Linear(Blue);

        private static double Linear(byte channel)
        {
            double share = channel / 255.0;
            return share <= 0.04045 ? share / 12.92 : Math.Pow((share + 0.055) / 1.055, 2.4);
        }

        private static byte Mix(byte first, byte second, double share) =>
            (byte)Math.Round(first + share * (second - first));
    }
}
