#nullable enable
using System;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text;
using HaptoFlow.Files;
using HaptoFlow.Preview;

namespace HaptoFlow.Editor
{
    internal enum SoundFormat
    {
        Wav = 0,
        Haptic = 1,
        Ahap = 2,
        Hjif = 3,
    }

    /// <summary>Writes sounds to WAV files and to clips for other tools.</summary>
    internal static class SoundExport
    {
        /// <summary>The endings of the files, by format.</summary>
        public static readonly string[] Endings = { ".wav", ".haptic", ".ahap", ".hjif" };

        /// <summary>A proposed file name, for example "wood 0.12 mps 1.5 N".</summary>
        public static string FileName(LabelMix material, StrokeSettings settings)
        {
            string name = string.Format(CultureInfo.InvariantCulture, "{0} {1:0.###} mps {2:0.##} N", material.Title,
                settings.SpeedMps, settings.ForceNewtons);
            return string.Concat(name.Select(letter => Path.GetInvalidFileNameChars().Contains(letter) ? '-' : letter));
        }

        /// <summary>Writes the samples as rendered, without the gain of playback: in units of <see
        /// cref="PreviewSound.FullScaleMps2"/>, 48 kHz, 32-bit float, one channel; or as a clip with the material as its
        /// title. The format is that of the file's ending.</summary>
        /// <param name="description">How the sound was made, for clips.</param>
        /// <returns>An error message; null on success.</returns>
        public static string? Write(string path, PreviewSound sound, string description)
        {
            try
            {
                int format = Array.IndexOf(Endings, Path.GetExtension(path).ToLowerInvariant());
                switch (format)
                {
                    case < 0:
                        return $"{Path.GetFileName(path)}: a sound is written to a file that ends in " +
                            string.Join(", ", Endings);
                    case (int)SoundFormat.Wav:
                        File.WriteAllBytes(path, WaveFile.Bytes(sound.Samples, PreviewSound.RateHz));
                        return null;
                    default:
                        WholeFile.Write(path, Clip(sound, description, (HapticClipFormat)(format - 1)));
                        return null;
                }
            }
            catch (Exception error) when (
                error is IOException || error is UnauthorizedAccessException || error is HaptoFlowException)
            {
                return error.Message;
            }
        }

        private static string Clip(PreviewSound sound, string description, HapticClipFormat format)
        {
            float[] wave = Array.ConvertAll(sound.Samples, sample => PreviewSound.FullScaleMps2 * sample);
            using HapticClipFile clip =
                HapticClipFile.FromWave(wave, PreviewSound.RateHz, sound.Material.Title, description);
            return clip.Write(format, DateTime.UtcNow);
        }
    }

    /// <summary>Writes RIFF WAVE files with one channel of 32-bit floats, as the command line does: format tag 3, with
    /// the fact chunk that formats other than PCM need.</summary>
    /// <remarks>Unity reads WAV files and does not write them.</remarks>
    internal static class WaveFile
    {
        private const int HeaderBytes = 12 + 8 + 18 + 8 + 4 + 8;
        private const short FloatFormat = 3;

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
