#nullable enable
using System;
using System.Buffers.Binary;
using System.Text;

namespace HaptoFlow.Preview
{
    /// <summary>Writes RIFF WAVE files with one channel of 32-bit floats, as the command line does: format tag 3, with
    /// the fact chunk that formats other than PCM need.</summary>
    /// <remarks>Unity reads WAV files and does not write them.</remarks>
    internal static class WaveFile
    {
        private const int HeaderBytes = 12 + 8 + 18 + 8 + 4 + 8;
        private const short FloatFormat = 3;

        /// <summary>The bytes of a file.</summary>
        /// <param name="samples">-1 to 1.</param>
        public static byte[] Bytes(ReadOnlySpan<float> samples, int rateHz)
        {
            int dataBytes = checked(samples.Length * sizeof(float));
            var file = new byte[checked(HeaderBytes + dataBytes)];
            var writer = new Writer(file);
            writer.Tag("RIFF");
            writer.Number(file.Length - 8);
            writer.Tag("WAVE");
            writer.Tag("fmt ");
            writer.Number(18);
            writer.Short(FloatFormat);
            writer.Short(1);
            writer.Number(rateHz);
            writer.Number(rateHz * sizeof(float));
            writer.Short(sizeof(float));
            writer.Short(8 * sizeof(float));
            writer.Short(0);
            writer.Tag("fact");
            writer.Number(4);
            writer.Number(samples.Length);
            writer.Tag("data");
            writer.Number(dataBytes);
            foreach (float sample in samples)
            {
                writer.Number(BitConverter.SingleToInt32Bits(sample));
            }
            return file;
        }

        private ref struct Writer
        {
            private Span<byte> rest;

            public Writer(Span<byte> file) => rest = file;

            public void Tag(string fourLetters)
            {
                Encoding.ASCII.GetBytes(fourLetters, rest);
                rest = rest.Slice(4);
            }

            public void Number(int value)
            {
                BinaryPrimitives.WriteInt32LittleEndian(rest, value);
                rest = rest.Slice(4);
            }

            public void Short(short value)
            {
                BinaryPrimitives.WriteInt16LittleEndian(rest, value);
                rest = rest.Slice(2);
            }
        }
    }
}
