#nullable enable
using System;
using System.Globalization;
using System.IO;
using System.Linq;
using HaptoFlow.Preview;

namespace HaptoFlow.Editor
{
    /// <summary>Writes sounds to WAV files.</summary>
    internal static class WaveExport
    {
        /// <summary>A proposed file name, for example "wood 0.12 mps 1.5 N".</summary>
        public static string FileName(LabelMix material, StrokeSettings settings)
        {
            string name = string.Format(CultureInfo.InvariantCulture, "{0} {1:0.###} mps {2:0.##} N", material.Title,
                settings.SpeedMps, settings.ForceNewtons);
            return string.Concat(name.Select(letter => Path.GetInvalidFileNameChars().Contains(letter) ? '-' : letter));
        }

        /// <summary>Writes the samples as rendered, without the gain of playback: 48 kHz, 32-bit float, one channel, in
        /// units of <see cref="PreviewSound.FullScaleMps2"/>.</summary>
        /// <returns>An error message; null on success.</returns>
        public static string? Write(string path, PreviewSound sound)
        {
            try
            {
                File.WriteAllBytes(path, WaveFile.Bytes(sound.Samples, PreviewSound.RateHz));
                return null;
            }
            catch (Exception error) when (error is IOException || error is UnauthorizedAccessException)
            {
                return error.Message;
            }
        }
    }
}
