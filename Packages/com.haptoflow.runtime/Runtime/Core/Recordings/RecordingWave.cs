#nullable enable
using System;
using System.Buffers.Binary;
using System.Text;

namespace HaptoFlow.Recordings
{
    /// <summary>A WAV file of 1 or 3 channels, PCM of 8 to 32 bits or float of 32 or 64 bits. Unity decodes audio only
    /// as clips at import, and .NET has no reader.</summary>
    internal sealed class RecordingWave
    {
        private const string Expected = "a WAV file of 1 or 3 channels, PCM or float";
        private const int PcmTag = 1;
        private const int FloatTag = 3;
        private const int ExtensibleTag = 0xfffe;
        private const int MinimumSamples = 4;

        private RecordingWave(int rateHz, int channels, float[] samples)
        {
            RateHz = rateHz;
            Channels = channels;
            Samples = samples;
        }

        public int RateHz { get; }

        public int Channels { get; }

        /// <summary>Interleaved samples within +-1.</summary>
        public float[] Samples { get; }

        /// <param name="file">Name of the file, for messages.</param>
        /// <exception cref="HaptoFlowException">Names the file, what was found and what is expected.</exception>
        public static RecordingWave Read(string file, byte[] bytes)
        {
            if (bytes.Length < 12 || Tag(bytes, 0) != "RIFF" || Tag(bytes, 8) != "WAVE")
            {
                throw RecordingError.Of(file, bytes.Length == 0 ? "empty file" : "not a RIFF WAVE file", Expected);
            }
            int format = Chunk(bytes, "fmt ", out int formatBytes);
            int data = Chunk(bytes, "data", out int dataBytes);
            if (format < 0 || formatBytes < 16 || data < 0)
            {
                throw RecordingError.Of(file, "a WAV file without format or samples", Expected);
            }
            int tag = BinaryPrimitives.ReadUInt16LittleEndian(bytes.AsSpan(format));
            tag = tag == ExtensibleTag && formatBytes >= 26
                ? BinaryPrimitives.ReadUInt16LittleEndian(bytes.AsSpan(format + 24))
                : tag;
            int channels = BinaryPrimitives.ReadUInt16LittleEndian(bytes.AsSpan(format + 2));
            int rateHz = BinaryPrimitives.ReadInt32LittleEndian(bytes.AsSpan(format + 4));
            int bits = BinaryPrimitives.ReadUInt16LittleEndian(bytes.AsSpan(format + 14));
            CheckForm(file, tag, channels, rateHz, bits);
            int width = bits / 8;
            int count = dataBytes / (width * channels) * channels;
            if (count < MinimumSamples * channels)
            {
                throw RecordingError.Of(file, $"{count / channels} samples", "4 at least");
            }
            var samples = new float[count];
            for (int index = 0; index < count; ++index)
            {
                samples[index] = Sample(bytes.AsSpan(data + index * width, width), tag == FloatTag);
                if (float.IsNaN(samples[index]) || float.IsInfinity(samples[index]))
                {
                    throw RecordingError.Of(file, $"sample {index / channels} is not finite", "numbers only");
                }
            }
            return new RecordingWave(rateHz, channels, samples);
        }

        private static void CheckForm(string file, int tag, int channels, int rateHz, int bits)
        {
            bool isPcm = tag == PcmTag && (bits == 8 || bits == 16 || bits == 24 || bits == 32);
            if (!isPcm && !(tag == FloatTag && (bits == 32 || bits == 64)))
            {
                throw RecordingError.Of(file, $"samples of format {tag} with {bits} bits", Expected);
            }
            if (channels != 1 && channels != 3)
            {
                throw RecordingError.Of(file, $"{channels} channels", "1 or 3: one axis, or X, Y and Z");
            }
            if (rateHz < RecordingSidecar.MinimumRateHz || rateHz > RecordingSidecar.MaximumRateHz)
            {
                throw RecordingError.Of(file, $"{rateHz} samples a second", "1000 to 192000");
            }
        }

        private static float Sample(ReadOnlySpan<byte> bytes, bool isFloat)
        {
            switch (bytes.Length)
            {
                case 1:
                    return (bytes[0] - 128) / 128f;
                case 2:
                    return BinaryPrimitives.ReadInt16LittleEndian(bytes) / 32768f;
                case 3:
                    return ((bytes[0] | (bytes[1] << 8) | (bytes[2] << 16)) << 8) / 2147483648f;
                case 4 when !isFloat:
                    return BinaryPrimitives.ReadInt32LittleEndian(bytes) / 2147483648f;
                case 4:
                    return BitConverter.Int32BitsToSingle(BinaryPrimitives.ReadInt32LittleEndian(bytes));
                default:
                    return (float)BitConverter.Int64BitsToDouble(BinaryPrimitives.ReadInt64LittleEndian(bytes));
            }
        }

        /// <summary>Offset of a chunk's content; -1 where there is none. The content of a truncated file ends with the
        /// file.</summary>
        private static int Chunk(byte[] bytes, string name, out int length)
        {
            long place = 12;
            while (place + 8 <= bytes.Length)
            {
                long size = BinaryPrimitives.ReadUInt32LittleEndian(bytes.AsSpan((int)place + 4));
                if (Tag(bytes, (int)place) == name)
                {
                    length = (int)Math.Min(size, bytes.Length - place - 8);
                    return (int)place + 8;
                }
                place += 8 + size + (size & 1);
            }
            length = 0;
            return -1;
        }

        private static string Tag(byte[] bytes, int place) => Encoding.ASCII.GetString(bytes, place, 4);
    }
}
