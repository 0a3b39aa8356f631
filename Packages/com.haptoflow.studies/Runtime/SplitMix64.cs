#nullable enable
namespace HaptoFlow.Studies
{
    /// <summary>The pseudorandom numbers of study plans: Steele, Lea and Flood (2014), Fast splittable pseudorandom
    /// number generators. System.Random cannot reproduce the training package's plans; this generator is the same
    /// there. One thread at a time.</summary>
    public sealed class SplitMix64
    {
        private ulong state;

        /// <summary>Starts the sequence of a seed.</summary>
        public SplitMix64(ulong seed) => state = seed;

        /// <summary>The numbers 0 to count - 1, shuffled by a seed (Fisher and Yates, from the end).</summary>
        /// <param name="count">0 or more.</param>
        public static int[] Shuffle(int count, ulong seed)
        {
            var random = new SplitMix64(seed);
            var order = new int[count];
            for (int index = 0; index < count; ++index)
            {
                order[index] = index;
            }
            for (int index = count - 1; index > 0; --index)
            {
                int other = (int)(random.Next() % (ulong)(index + 1));
                (order[index], order[other]) = (order[other], order[index]);
            }
            return order;
        }

        /// <summary>The next number, 0 to 2^64 - 1.</summary>
        public ulong Next()
        {
            unchecked
            {
                state += 0x9E3779B97F4A7C15ul;
                ulong mixed = state;
                mixed = (mixed ^ (mixed >> 30)) * 0xBF58476D1CE4E5B9ul;
                mixed = (mixed ^ (mixed >> 27)) * 0x94D049BB133111EBul;
                return mixed ^ (mixed >> 31);
            }
        }
    }
}
