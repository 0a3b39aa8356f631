#nullable enable
using System;
using System.Buffers.Binary;
using System.Globalization;
using System.Text;

namespace HaptoFlow.Model
{
    /// <summary>The first part of a .haptoflow file: magic, version, lengths, checksums and header text.</summary>
    internal static class ModelFile
    {
        public const int PrefixBytes = 32;
        private const uint FormatVersion = 1;
        private const long MaximumHeaderBytes = 4_194_304;
        private const long MaximumFileBytes = 268_435_456;
        private const int BlobAlignment = 64;

        private static readonly byte[] Magic = Encoding.ASCII.GetBytes("HAPTFLOW");

        /// <summary>The text of the JSON header, after its checksums were verified.</summary>
        /// <exception cref="HaptoFlowException">The bytes break a rule of the format; the message names it.</exception>
        public static string HeaderText(ReadOnlySpan<byte> file)
        {
            CheckPrefix(file);
            long headerBytes = BinaryPrimitives.ReadUInt32LittleEndian(file.Slice(12));
            CheckLengths(file, headerBytes, BinaryPrimitives.ReadUInt64LittleEndian(file.Slice(16)));
            ReadOnlySpan<byte> header = file.Slice(PrefixBytes, (int)headerBytes);
            if (Crc32.Of(header) != BinaryPrimitives.ReadUInt32LittleEndian(file.Slice(24)))
            {
                throw Refuse(HaptoFlowStatus.ModelDamaged,
                    "the JSON header does not match its checksum at byte 24: get it again");
            }
            try
            {
                return new UTF8Encoding(false, true).GetString(header).TrimEnd(' ');
            }
            catch (DecoderFallbackException error)
            {
                throw new HaptoFlowException(
                    HaptoFlowStatus.ModelDamaged, "the JSON header is not UTF-8: get it again", error);
            }
        }

        private static void CheckPrefix(ReadOnlySpan<byte> file)
        {
            int present = Math.Min(file.Length, Magic.Length);
            if (!file.Slice(0, present).SequenceEqual(Magic.AsSpan(0, present)))
            {
                throw Refuse(HaptoFlowStatus.NotAModel,
                    "bytes 0 to 7 are not \"HAPTFLOW\": this is not a .haptoflow file");
            }
            if (file.Length < PrefixBytes)
            {
                throw Refuse(HaptoFlowStatus.ModelTruncated,
                    "the file has {0} bytes, and its first part alone takes 32: get it again", file.Length);
            }
            if (Crc32.Of(file.Slice(0, 28)) != BinaryPrimitives.ReadUInt32LittleEndian(file.Slice(28)))
            {
                throw Refuse(HaptoFlowStatus.ModelDamaged,
                    "bytes 0 to 27 do not match their checksum at byte 28: get it again");
            }
            uint version = BinaryPrimitives.ReadUInt32LittleEndian(file.Slice(8));
            if (version > FormatVersion)
            {
                throw Refuse(HaptoFlowStatus.ModelTooNew,
                    "format version {0} at byte 8; this reader knows version 1: update HaptoFlow", version);
            }
            if (version != FormatVersion)
            {
                throw Refuse(HaptoFlowStatus.ModelInconsistent, "format version 0 at byte 8; expected 1");
            }
        }

        private static void CheckLengths(ReadOnlySpan<byte> file, long headerBytes, ulong fileBytes)
        {
            if (headerBytes > MaximumHeaderBytes || fileBytes > MaximumFileBytes)
            {
                throw Refuse(HaptoFlowStatus.ModelOversized,
                    "header of {0} bytes (byte 12), file of {1} (byte 16); the limits are 4194304 and 268435456",
                    headerBytes, fileBytes);
            }
            if (fileBytes > (ulong)file.Length)
            {
                throw Refuse(HaptoFlowStatus.ModelTruncated,
                    "the file says {0} bytes (byte 16) and has {1}: get it again", fileBytes, file.Length);
            }
            if (fileBytes < (ulong)file.Length)
            {
                throw Refuse(HaptoFlowStatus.ModelInconsistent,
                    "the file says {0} bytes (byte 16) and has {1}: something was appended", fileBytes, file.Length);
            }
            if (headerBytes < 2 || headerBytes > file.Length - PrefixBytes ||
                (headerBytes + PrefixBytes) % BlobAlignment != 0)
            {
                throw Refuse(HaptoFlowStatus.ModelInconsistent,
                    "header length {0} at byte 12; expected at least 2, inside the file, ending on a multiple of 64 " +
                    "bytes",
                    headerBytes);
            }
        }

        private static HaptoFlowException Refuse(HaptoFlowStatus status, string message, params object[] numbers) =>
            new HaptoFlowException(status, string.Format(CultureInfo.InvariantCulture, message, numbers));
    }
}
