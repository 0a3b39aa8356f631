#nullable enable
using System;
using System.IO;
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
            var file = new MemoryStream(checked(HeaderBytes + dataBytes));
            using var writer = new BinaryWriter(file, Encoding.ASCII);
            writer.Write("RIFF".ToCharArray());
            writer.Write(HeaderBytes + dataBytes - 8);
            writer.Write("WAVEfmt ".ToCharArray());
            writer.Write(18);
            writer.Write(FloatFormat);
            writer.Write((short)1);
            writer.Write(rateHz);
            writer.Write(rateHz * sizeof(float));
            writer.Write((short)sizeof(float));
            writer.Write((short)(8 * sizeof(float)));
            writer.Write((short)0);
            writer.Write("fact".ToCharArray());
            writer.Write(4);
            writer.Write(samples.Length);
            writer.Write("data".ToCharArray());
            writer.Write(dataBytes);
            foreach (float sample in samples)
            {
                writer.Write(sample);
            }
            return file.ToArray();
        }
    }
}
