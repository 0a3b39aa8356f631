#nullable enable
using System;
using System.Globalization;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Draws a level as a bar from -60 dB to full scale.</summary>
    internal static class LevelMeter
    {
        private const double MinimumDecibels = -60.0;
        private static readonly string[] Captions = CreateCaptions();

        public static void Draw(Rect place, float level)
        {
            double decibels = DecibelsOf(level);
            EditorGUI.ProgressBar(place, ShareOf(decibels), CaptionOf(decibels));
        }

        /// <summary>The level in decibels of full scale, at least -60.</summary>
        public static double DecibelsOf(float level) => level > 0f
            ? Math.Max(MinimumDecibels, 20.0 * Math.Log10(level))
            : MinimumDecibels;

        /// <summary>The length of the bar, from 0 to 1.</summary>
        public static float ShareOf(double decibels) =>
            (float)Math.Max(0.0, Math.Min(1.0, 1.0 - decibels / MinimumDecibels));

        /// <summary>The level as text, in whole decibels. Allocates nothing.</summary>
        public static string CaptionOf(double decibels)
        {
            int index = (int)Math.Round(decibels - MinimumDecibels);
            return Captions[Math.Max(0, Math.Min(Captions.Length - 1, index))];
        }

        private static string[] CreateCaptions()
        {
            var captions = new string[1 - (int)MinimumDecibels];
            for (int index = 0; index < captions.Length; ++index)
            {
                captions[index] = string.Format(
                    CultureInfo.InvariantCulture, "level {0:0} dB of full scale", index + MinimumDecibels);
            }
            captions[0] = "silent";
            return captions;
        }
    }
}
