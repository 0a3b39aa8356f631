#nullable enable
using System;

namespace HaptoFlow.Preview
{
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
}
