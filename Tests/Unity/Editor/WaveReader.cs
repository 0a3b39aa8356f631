#nullable enable
using System;
using System.Buffers.Binary;
using System.Collections.Generic;
using System.Text;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    /// <summary>Reads RIFF WAVE files by the format's rules, independently of the writer under test.</summary>
    internal sealed class WaveReader
    {
        private readonly Dictionary<string, byte[]> chunks = new Dictionary<string, byte[]>();

        public WaveReader(byte[] file)
        {
            Assert.That(Tag(file, 0), Is.EqualTo("RIFF"));
            Assert.That(Number(file, 4), Is.EqualTo(file.Length - 8));
            Assert.That(Tag(file, 8), Is.EqualTo("WAVE"));
            int place = 12;
            while (place < file.Length)
            {
                int bytes = Number(file, place + 4);
                chunks.Add(Tag(file, place), file.AsSpan(place + 8, bytes).ToArray());
                place += 8 + bytes + (bytes & 1);
            }
            Assert.That(place, Is.EqualTo(file.Length));
        }

        public int Format => Short(0);

        public int Channels => Short(2);

        public int RateHz => Number(chunks["fmt "], 4);

        public int BytesPerSecond => Number(chunks["fmt "], 8);

        public int BlockBytes => Short(12);

        public int BitsPerSample => Short(14);

        public int FactSamples => Number(chunks["fact"], 0);

        public float[] Samples()
        {
            byte[] data = chunks["data"];
            var samples = new float[data.Length / 4];
            for (int index = 0; index < samples.Length; ++index)
            {
                samples[index] = BitConverter.Int32BitsToSingle(Number(data, 4 * index));
            }
            return samples;
        }

        private int Short(int place) => BinaryPrimitives.ReadInt16LittleEndian(chunks["fmt "].AsSpan(place));

        private static int Number(byte[] bytes, int place) =>
            BinaryPrimitives.ReadInt32LittleEndian(bytes.AsSpan(place));

        private static string Tag(byte[] bytes, int place) => Encoding.ASCII.GetString(bytes, place, 4);
    }
}
