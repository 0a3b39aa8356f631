#nullable enable
using System;

namespace HaptoFlow.Tests
{
    /// <summary>CRC-32 as in zlib and PNG. System.IO.Hashing is not part of Unity's class libraries.</summary>
    public static class Crc32
    {
        private static readonly uint[] Table = MakeTable();

        public static uint Of(ReadOnlySpan<byte> bytes)
        {
            uint crc = 0xffffffffu;
            foreach (byte value in bytes)
            {
                crc = Table[(crc ^ value) & 0xff] ^ (crc >> 8);
            }
            return ~crc;
        }

        private static uint[] MakeTable()
        {
            var table = new uint[256];
            for (uint index = 0; index < table.Length; ++index)
            {
                uint entry = index;
                for (int bit = 0; bit < 8; ++bit)
                {
                    entry = (entry & 1) != 0 ? 0xedb88320u ^ (entry >> 1) : entry >> 1;
                }
                table[index] = entry;
            }
            return table;
        }
    }
}
