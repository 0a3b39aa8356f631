#nullable enable
using System;

namespace HaptoFlow.Studies
{
    /// <summary>Orders of treatments in which each treatment is once at each position and follows each other treatment
    /// equally often: Williams (1949), Experimental designs balanced for the estimation of residual effects of
    /// treatments. Any thread.</summary>
    public static class WilliamsDesign
    {
        /// <summary>The rows of the design: as many as treatments for an even number, twice as many for an odd one, and
        /// one row for one treatment.</summary>
        /// <param name="count">Number of treatments, 1 or more.</param>
        /// <exception cref="ArgumentOutOfRangeException">The count is below 1.</exception>
        public static int[][] Rows(int count)
        {
            if (count < 1)
            {
                throw new ArgumentOutOfRangeException(nameof(count), count, "a design has at least one treatment");
            }
            bool isMirrored = count % 2 == 1 && count > 1;
            var rows = new int[isMirrored ? 2 * count : count][];
            for (int shift = 0; shift < count; ++shift)
            {
                rows[shift] = Row(count, shift);
                if (isMirrored)
                {
                    rows[count + shift] = (int[])rows[shift].Clone();
                    Array.Reverse(rows[count + shift]);
                }
            }
            return rows;
        }

        private static int[] Row(int count, int shift)
        {
            var row = new int[count];
            for (int place = 0; place < count; ++place)
            {
                int zigzag = place % 2 == 1 ? (place + 1) / 2 : count - place / 2;
                row[place] = (zigzag + shift) % count;
            }
            return row;
        }
    }
}
