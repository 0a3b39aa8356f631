#nullable enable
using System;
using System.Buffers.Binary;
using System.Text;
using System.Text.RegularExpressions;

namespace HaptoFlow.Tests
{
    /// <summary>Changed copies of a model file.</summary>
    public static class ModelBytes
    {
        private const int HeaderStart = 32;

        public static byte[] Truncated(byte[] file, int length) => file.AsSpan(0, length).ToArray();

        public static byte[] Flipped(byte[] file, int position)
        {
            byte[] copy = (byte[])file.Clone();
            copy[position] ^= 1;
            return copy;
        }

        /// <summary>A copy with other measured figures, the same for all tiers, and a matching checksum.</summary>
        public static byte[] WithFigures(byte[] file, string accuracyJson, string costJson) => WithHeader(file, header =>
            Regex.Replace(Regex.Replace(header, "\"accuracy\":\\s*\\{[^}]*\\}", "\"accuracy\":" + accuracyJson),
                "\"cost\":\\s*\\{[^}]*\\}", "\"cost\":" + costJson));

        /// <summary>A copy with a changed header and matching checksums.</summary>
        public static byte[] WithHeader(byte[] file, Func<string, string> change)
        {
            int length = BinaryPrimitives.ReadInt32LittleEndian(file.AsSpan(12));
            string header = Encoding.UTF8.GetString(file, HeaderStart, length);
            // The header has to keep its length, so fields that no test reads are shortened.
            string shortened = Regex.Replace(header, "\"commit\":\\s*\"[^\"]*\"", "\"commit\":\"\"");
            shortened = Regex.Replace(shortened, "\"configuration\":\\s*\\{.*?\\},\\s*\"created\"",
                "\"configuration\":{},\"created\"", RegexOptions.Singleline);
            byte[] text = Encoding.UTF8.GetBytes(change(shortened).TrimEnd(' ').PadRight(length));
            if (text.Length != length)
            {
                throw new InvalidOperationException($"the header has {length} bytes and would have {text.Length}");
            }
            byte[] copy = (byte[])file.Clone();
            text.CopyTo(copy, HeaderStart);
            BinaryPrimitives.WriteUInt32LittleEndian(copy.AsSpan(24), Crc(text));
            BinaryPrimitives.WriteUInt32LittleEndian(copy.AsSpan(28), Crc(copy.AsSpan(0, 28)));
            return copy;
        }

        // CRC-32 as in zlib and PNG. System.IO.Hashing is not part of Unity's class libraries.
        private static uint Crc(ReadOnlySpan<byte> bytes)
        {
            uint crc = 0xffffffffu;
            foreach (byte value in bytes)
            {
                crc ^= value;
                for (int bit = 0; bit < 8; ++bit)
                {
                    crc = (crc & 1) != 0 ? 0xedb88320u ^ (crc >> 1) : crc >> 1;
                }
            }
            return ~crc;
        }
    }
}
