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

        public bool Equals(Colour other) =>
            Red == other.Red && Green == other.Green && Blue == other.Blue && Opacity == other.Opacity;

        public override bool Equals(object? other) => other is Colour colour && Equals(colour);

        public override int GetHashCode() => HashCode.Combine(Red, Green, Blue, Opacity);

        private static byte Mix(byte first, byte second, double share) =>
            (byte)Math.Round(first + share * (second - first));
    }
}
