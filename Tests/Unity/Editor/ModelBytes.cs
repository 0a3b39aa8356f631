#nullable enable
using System;
using System.Buffers.Binary;
using System.Text;
using System.Text.RegularExpressions;
using HaptoFlow.Tests;

namespace HaptoFlow.EditorTests
{
    /// <summary>Changed copies of a model file.</summary>
    internal static class ModelBytes
    {
        private const int HeaderStart = 32;

        public static byte[] Truncated(byte[] file, int length) => file.AsSpan(0, length).ToArray();

        /// <summary>A copy with one bit flipped.</summary>
        public static byte[] Flipped(byte[] file, int position)
        {
            byte[] copy = (byte[])file.Clone();
            copy[position] ^= 1;
            return copy;
        }

        /// <summary>The offset of the first part.</summary>
        public static int PartsStart(byte[] file) => HeaderStart + HeaderLength(file);

        /// <summary>A copy with other measured figures, the same for all tiers, and a matching checksum.</summary>
        public static byte[] WithFigures(byte[] file, string accuracyJson, string costJson) => WithHeader(file, header =>
            Regex.Replace(Regex.Replace(header, "\"accuracy\":\\s*\\{[^}]*\\}", "\"accuracy\":" + accuracyJson),
                "\"cost\":\\s*\\{[^}]*\\}", "\"cost\":" + costJson));

        /// <summary>A copy with a changed header and matching checksums.</summary>
        public static byte[] WithHeader(byte[] file, Func<string, string> change)
        {
            int length = HeaderLength(file);
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
            BinaryPrimitives.WriteUInt32LittleEndian(copy.AsSpan(24), Crc32.Of(text));
            BinaryPrimitives.WriteUInt32LittleEndian(copy.AsSpan(28), Crc32.Of(copy.AsSpan(0, 28)));
            return copy;
        }

        private static int HeaderLength(byte[] file) => BinaryPrimitives.ReadInt32LittleEndian(file.AsSpan(12));
    }
}
