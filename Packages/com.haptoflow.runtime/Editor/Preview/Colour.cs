#nullable enable
using System;

namespace HaptoFlow.Preview
{
    /// <summary>An sRGB colour with opacity, each channel from 0 to 255.</summary>
    internal readonly struct Colour
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

        private static byte Mix(byte first, byte second, double share) =>
            (byte)Math.Round(first + share * (second - first));
    }

    /// <summary>The colours of the charts, one palette for each skin of the editor.</summary>
    /// <param name="Soft">Secondary text: axis numbers and remarks.</param>
    internal sealed record Palette(Colour Window, Colour Card, Colour Plot, Colour Grid, Colour Ink, Colour Soft,
        Colour First, Colour Second, Colour Speed, Colour Force, Colour Patch)
    {
        public static readonly Palette Dark = new Palette(
            Window: Colour.Of(0x383838),
            Card: Colour.Of(0x26282c),
            Plot: Colour.Of(0x1b1d20),
            Grid: Colour.Of(0x383c43),
            Ink: Colour.Of(0xeceae6),
            Soft: Colour.Of(0xa6acb6),
            First: Colour.Of(0x5fb4f5),
            Second: Colour.Of(0xffa34d),
            Speed: Colour.Of(0x63d0b2),
            Force: Colour.Of(0xee8fc7),
            Patch: Colour.Of(0x33373d));

        public static readonly Palette Light = new Palette(
            Window: Colour.Of(0xc8c8c8),
            Card: Colour.Of(0xf5f4f1),
            Plot: Colour.Of(0xffffff),
            Grid: Colour.Of(0xdedbd4),
            Ink: Colour.Of(0x1f2227),
            Soft: Colour.Of(0x565c66),
            First: Colour.Of(0x1a6bb0),
            Second: Colour.Of(0xb24b06),
            Speed: Colour.Of(0x0c7a66),
            Force: Colour.Of(0xa8357f),
            Patch: Colour.Of(0xe6e0d4));
    }

    /// <summary>Matplotlib's colour map "inferno" (CC0), interpolated between 17 evenly spaced colours. Its lightness
    /// rises steadily, so that a higher value always looks brighter.</summary>
    internal static class ColourMap
    {
        private static readonly int[] Steps =
        {
            0x000004, 0x0b0724, 0x210c4a, 0x3d0965, 0x57106e, 0x71196e, 0x8a226a, 0xa32c61, 0xbc3754,
            0xd24645, 0xe45a31, 0xf1731d, 0xf98e09, 0xfcac11, 0xf9cb35, 0xf2ea69, 0xfcffa4,
        };

        private static readonly Colour[] Table = Fill();

        /// <summary>All colours, the darkest in the lowest row: for legends.</summary>
        public static ColourImage Column { get; } = MakeColumn();

        /// <param name="share">0 to 1; NaN counts as 0.</param>
        public static Colour At(double share)
        {
            double limited = share > 0.0 ? Math.Min(1.0, share) : 0.0;
            return Table[(int)(limited * (Table.Length - 1) + 0.5)];
        }

        private static ColourImage MakeColumn()
        {
            var image = new ColourImage(1, Table.Length);
            for (int y = 0; y < Table.Length; ++y)
            {
                image.Set(0, y, Table[y]);
            }
            return image;
        }

        private static Colour[] Fill()
        {
            var table = new Colour[256];
            for (int index = 0; index < table.Length; ++index)
            {
                double place = index * (Steps.Length - 1) / (table.Length - 1.0);
                int lower = Math.Min((int)place, Steps.Length - 2);
                table[index] = Colour.Between(Colour.Of(Steps[lower]), Colour.Of(Steps[lower + 1]), place - lower);
            }
            return table;
        }
    }

    /// <summary>A buffer of opaque colours. Immutable by convention: a texture made from it stays valid.</summary>
    internal sealed record ColourImage(int Width, int Height)
    {
        public const int BytesPerPixel = 4;

        /// <summary>Red, green, blue and opacity of each pixel. The lowest row is first, as in textures.</summary>
        public byte[] Pixels { get; } = new byte[Width * Height * BytesPerPixel];

        /// <param name="y">0 is the lowest row.</param>
        public void Set(int x, int y, Colour colour)
        {
            int index = (y * Width + x) * BytesPerPixel;
            Pixels[index] = colour.Red;
            Pixels[index + 1] = colour.Green;
            Pixels[index + 2] = colour.Blue;
            Pixels[index + 3] = colour.Opacity;
        }
    }
}
