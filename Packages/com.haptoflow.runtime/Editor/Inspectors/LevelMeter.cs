#nullable enable
using System;
using System.Globalization;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>A level as a bar from -60 dB to full scale.</summary>
    internal static class LevelMeter
    {
        private const double LowestDecibels = -60.0;
        private static readonly string[] Captions = MakeCaptions();

        public static void Draw(Rect place, float level)
        {
            double decibels = DecibelsOf(level);
            EditorGUI.ProgressBar(place, ShareOf(decibels), CaptionOf(decibels));
        }

        /// <summary>Relative to full scale, not below the lowest that is shown.</summary>
        public static double DecibelsOf(float level) => level > 0f
            ? Math.Max(LowestDecibels, 20.0 * Math.Log10(level))
            : LowestDecibels;

        /// <summary>0 to 1.</summary>
        public static float ShareOf(double decibels) =>
            (float)Math.Max(0.0, Math.Min(1.0, 1.0 - decibels / LowestDecibels));

        /// <summary>In whole decibels; made once.</summary>
        public static string CaptionOf(double decibels)
        {
            int index = (int)Math.Round(decibels - LowestDecibels);
            return Captions[Math.Max(0, Math.Min(Captions.Length - 1, index))];
        }

        private static string[] MakeCaptions()
        {
            var captions = new string[1 - (int)LowestDecibels];
            for (int index = 0; index < captions.Length; ++index)
            {
                captions[index] = string.Format(
                    CultureInfo.InvariantCulture, "level {0:0} dB of full scale", index + LowestDecibels);
            }
            captions[0] = "silent";
            return captions;
        }
    }
}
