#nullable enable
using UnityEngine;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>The operator's buttons for the alignment before the first trial. They are drawn with Unity's immediate
    /// mode, which the screen shows and the headset does not.</summary>
    public sealed class AlignmentButtons : MonoBehaviour
    {
        private const float Left = 660f;
        private const float Top = 10f;
        private const float Width = 150f;
        private const float Height = 33f;

        private SimilarityStudyScene scene = null!;

        /// <summary>Adds the buttons to the scene. They are shown until the session begins.</summary>
        public static AlignmentButtons Create(SimilarityStudyScene scene)
        {
            var buttons = scene.gameObject.AddComponent<AlignmentButtons>();
            buttons.scene = scene;
            return buttons;
        }

        private void OnGUI()
        {
            if (scene.Session != null || scene.Models == null)
            {
                return;
            }
            HapticAlignment alignment = scene.Alignment.Alignment;
            if (!alignment.IsTaking)
            {
                if (Button(0, "Align"))
                {
                    scene.Alignment.Begin();
                }
            }
            else if (Button(0, "Take point"))
            {
                scene.Alignment.TakePoint();
            }
            if (Button(1, "Take back"))
            {
                alignment.Undo();
            }
        }

        private static bool Button(int row, string text) =>
            GUI.Button(new Rect(Left, Top + 1.2f * row * Height, Width, Height), text);
    }
}
