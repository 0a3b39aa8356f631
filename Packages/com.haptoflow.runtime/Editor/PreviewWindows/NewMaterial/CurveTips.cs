#nullable enable
using HaptoFlow.Preview;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The tooltips of <see cref="LearningPanel"/>. Main thread, within OnGUI.</summary>
    internal static class CurveTips
    {
        private static readonly GUIContent Spectra = new GUIContent("",
            "The power at each frequency, with one chart for each range of speed that was recorded. The learnt line " +
            "should lie on the recorded one.");
        private static readonly GUIContent Levels = new GUIContent("",
            "The strength over speed, with one chart for each range of force. Points were recorded, the shaded range " +
            "holds their speeds, and the learnt line is dashed where it is extrapolated.");
        private static readonly GUIContent Kurtosis = new GUIContent("",
            "How rare and strong single events are at each speed. Even noise has 3, knocks and crackles have more.");
        private static readonly GUIContent Ribs = new GUIContent("",
            "The share of the ribs in the vibration at each speed. At 0 dB there is nothing but ribs, at -40 dB there " +
            "are none.");

        /// <param name="charts">The box of the panel.</param>
        public static void Draw(Box charts)
        {
            GUI.Label(LearningPanel.Spectra(charts).ToRect(), Spectra, GUIStyle.none);
            GUI.Label(LearningPanel.Levels(charts).ToRect(), Levels, GUIStyle.none);
            GUI.Label(LearningPanel.Kurtosis(charts).ToRect(), Kurtosis, GUIStyle.none);
            GUI.Label(LearningPanel.Ribs(charts).ToRect(), Ribs, GUIStyle.none);
        }
    }
}
