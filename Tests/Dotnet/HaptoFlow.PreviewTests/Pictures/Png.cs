using System;
using System.Buffers.Binary;
using System.IO;
using System.IO.Compression;
using System.Security.Cryptography;
using HaptoFlow.Preview;

namespace HaptoFlow.PreviewTests
{
    /// <summary>Portable Network Graphics (ISO/IEC 15948), eight bits of red, green, blue and opacity.</summary>
    internal static class Png
    {
        private static readonly byte[] Signature = { 0x89, (byte)'P', (byte)'N', (byte)'G', 13, 10, 26, 10 };

        /// <param name="model">The model file that was drawn with; the picture names its SHA-256. Null for a picture without one.</param>
        public static void Write(string path, PixelCanvas canvas, byte[]? model = null)
        {
            Directory.CreateDirectory(Path.GetDirectoryName(path)!);
            using FileStream file = File.Create(path);
            file.Write(Signature);
            var header = new byte[13];
            BinaryPrimitives.WriteInt32BigEndian(header, canvas.PixelWidth);
            BinaryPrimitives.WriteInt32BigEndian(header.AsSpan(4), canvas.PixelHeight);
            header[8] = 8;
            header[9] = 6;
            Chunk(file, "IHDR", header);
            if (model != null)
            {
                string name = Convert.ToHexString(SHA256.HashData(model)).ToLowerInvariant();
                Chunk(file, "tEXt", System.Text.Encoding.Latin1.GetBytes("Model-SHA-256\0" + name));
            }
            Chunk(file, "IDAT", Compressed(canvas));
            Chunk(file, "IEND", Array.Empty<byte>());
        }

        /// <summary>Every row as differences to the pixel before it (filter 1), deflated.</summary>
        private static byte[] Compressed(PixelCanvas canvas)
        {
            using var packed = new MemoryStream();
            using (var zlib = new ZLibStream(packed, CompressionLevel.SmallestSize, true))
            {
                int stride = 4 * canvas.PixelWidth;
                var row = new byte[1 + stride];
                row[0] = 1;
                for (int y = 0; y < canvas.PixelHeight; ++y)
                {
                    ReadOnlySpan<byte> pixels = canvas.Pixels.AsSpan(y * stride, stride);
                    for (int place = 0; place < stride; ++place)
                    {
                        row[1 + place] = (byte)(pixels[place] - (place < 4 ? 0 : pixels[place - 4]));
                    }
                    zlib.Write(row);
                }
            }
            return packed.ToArray();
        }

        private static void Chunk(Stream file, string name, byte[] content)
        {
            var typed = new byte[4 + content.Length];
            System.Text.Encoding.ASCII.GetBytes(name, typed);
            content.CopyTo(typed, 4);
            var number = new byte[4];
            BinaryPrimitives.WriteInt32BigEndian(number, content.Length);
            file.Write(number);
            file.Write(typed);
            BinaryPrimitives.WriteUInt32BigEndian(number, Checksum(typed));
            file.Write(number);
        }

        /// <summary>CRC-32 as the standard's annex D gives it.</summary>
        internal static uint Checksum(ReadOnlySpan<byte> bytes)
        {
            uint remainder = 0xffffffffu;
            foreach (byte each in bytes)
            {
                remainder ^= each;
                for (int bit = 0; bit < 8; ++bit)
                {
                    remainder = (remainder >> 1) ^ ((remainder & 1) != 0 ? 0xedb88320u : 0u);
                }
            }
            return ~remainder;
        }
    }
}
