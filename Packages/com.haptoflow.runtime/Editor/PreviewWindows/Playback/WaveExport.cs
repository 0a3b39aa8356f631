#nullable enable
using System;
using System.Globalization;
using System.IO;
using System.Linq;
using HaptoFlow.Preview;

namespace HaptoFlow.Editor
{
    /// <summary>Writes what is heard to a file.</summary>
    internal static class WaveExport
    {
        /// <summary>For example "wood 0.12 mps 1.5 N".</summary>
        public static string FileName(LabelMix material, StrokeSettings settings)
        {
            string name = string.Format(CultureInfo.InvariantCulture, "{0} {1:0.###} mps {2:0.##} N", material.Title,
                settings.SpeedMps, settings.ForceNewtons);
            return string.Concat(name.Select(letter => Path.GetInvalidFileNameChars().Contains(letter) ? '-' : letter));
        }

        /// <summary>48 kHz, 32-bit float, one channel, +-1 is <see cref="PreviewSound.FullScaleMps2"/>: as rendered,
        /// without the speakers' gain.</summary>
        /// <returns>What went wrong; null where nothing did.</returns>
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
