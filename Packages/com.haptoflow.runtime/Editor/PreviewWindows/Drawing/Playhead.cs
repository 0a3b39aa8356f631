#nullable enable
using System.Collections.Generic;
using HaptoFlow.Preview;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Marks where playback is upon pictures that stay as they are. Main thread, within OnGUI.</summary>
    internal static class Playhead
    {
        private const double TipPoints = 8.0;

        /// <summary>The tip on the patch, while it touches.</summary>
        public static void DrawTip(Box patch, in StrokeState tip, Palette palette, int material)
        {
            if (tip.Touching)
            {
                (double x, double y) = PatchPicture.ToPoints(patch, tip.XMetres, tip.YMetres);
                var mark = new Box(x - 0.5 * TipPoints, y - 0.5 * TipPoints, TipPoints, TipPoints);
                EditorGUI.DrawRect(mark.ToRect(), ToColor(material == 0 ? palette.First : palette.Second));
            }
        }

        /// <summary>A line through every waveform and spectrogram.</summary>
        public static void DrawLines(Box charts, IReadOnlyList<AnalysedSound> sounds, double seconds, Palette palette)
        {
            for (int index = 0; index < sounds.Count; ++index)
            {
                double share = seconds / sounds[index].Sound.DurationSeconds;
                Draw(SoundPanel.Waveform(charts, index, sounds.Count), share, palette);
                Draw(SoundPanel.SpectrogramBox(charts, index, sounds.Count), share, palette);
            }
        }

        public static Rect ToRect(this Box box) =>
            new Rect((float)box.Left, (float)box.Top, (float)box.Width, (float)box.Height);

        private static void Draw(Box plot, double share, Palette palette) =>
            EditorGUI.DrawRect(plot.Columns(share * plot.Width, 1.0).ToRect(), ToColor(palette.Ink));

        private static Color ToColor(Colour colour) =>
            new Color(colour.Red / 255f, colour.Green / 255f, colour.Blue / 255f);
    }
}
