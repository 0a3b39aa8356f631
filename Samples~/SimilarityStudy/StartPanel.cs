#nullable enable
using UnityEngine;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>The operator's buttons before the first trial: participant, alignment, begin. On the screen, not in the
    /// headset.</summary>
    public sealed class StartPanel : MonoBehaviour
    {
        private const float Left = 660f;
        private const float Width = 170f;
        private const float Height = 32f;
        private const float Margin = 10f;

        /// <summary>What the buttons act on.</summary>
        public SimilarityScene? Scene { get; set; }

        private void OnGUI()
        {
            SimilarityScene? scene = Scene;
            if (scene == null || scene.Session != null || scene.Models == null)
            {
                return;
            }
            if (Button(0, $"Participant P{scene.Participant:00}: next"))
            {
                ++scene.Participant;
                scene.Retry();
            }
            if (scene.Participant > 1 && Button(1, "Participant: previous"))
            {
                --scene.Participant;
                scene.Retry();
            }
            if (Button(2, scene.Alignment.Alignment.IsTaking ? "Take point" : "Align"))
            {
                if (scene.Alignment.Alignment.IsTaking)
                {
                    scene.Alignment.TakePoint();
                }
                else
                {
                    scene.Alignment.Begin();
                }
            }
            if (Button(3, "Undo alignment"))
            {
                scene.Alignment.Alignment.Undo();
            }
            if (scene.CanBegin && Button(4, "Begin"))
            {
                scene.Begin();
            }
        }

        private static bool Button(int row, string text) =>
            GUI.Button(new Rect(Left, Margin + row * (Height + Margin), Width, Height), text);
    }
}
