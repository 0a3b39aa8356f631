#nullable enable
using System.Collections.Generic;
using HaptoFlow.Preview;
using UnityEditor;

namespace HaptoFlow.Editor
{
    /// <summary>Marks the position of playback on top of pictures that need not be drawn again. Main thread, within
    /// OnGUI.</summary>
    internal static class Playhead
    {
        private const double TipPoints = 8.0;

        /// <summary>Draws the tip on the patch while it touches.</summary>
        /// <param name="material">Index of the material that is played.</param>
        public static void DrawTip(Box patch, in StrokeState tip, Palette palette, int material)
        {
            if (tip.Touching)
            {
                (double x, double y) = PatchPicture.ToPoints(patch, tip.XMetres, tip.YMetres);
                var mark = new Box(x - 0.5 * TipPoints, y - 0.5 * TipPoints, TipPoints, TipPoints);
                EditorGUI.DrawRect(mark.ToRect(), (material == 0 ? palette.First : palette.Second).ToColor());
            }
        }

        /// <summary>Draws a line through every waveform and spectrogram.</summary>
        public static void DrawLines(Box charts, IReadOnlyList<AnalysedSound> sounds, double seconds, Palette palette)
        {
            for (int index = 0; index < sounds.Count; ++index)
            {
                double share = seconds / sounds[index].Sound.DurationSeconds;
                Draw(SoundPanel.Waveform(charts, index, sounds.Count), share, palette);
                Draw(SoundPanel.SpectrogramBox(charts, index, sounds.Count), share, palette);
            }
        }

        private static void Draw(Box plot, double share, Palette palette) =>
            EditorGUI.DrawRect(plot.Columns(share * plot.Width, 1.0).ToRect(), palette.Ink.ToColor());
    }
}
