#nullable enable
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
using UnityEngine;

namespace HaptoFlow.SampleScenes
{
    /// <summary>Aligns the sample's table with a real one: the pen touches three corners of a sheet of A4 paper on the
    /// real table. After that, for pens that measure their tip force, the force decides when they touch.</summary>
    internal sealed class AlignmentStep : MonoBehaviour
    {
        private const string Hint = "A, or the left hand's first button: put this table onto a real one";

        // A sheet of A4 paper with its long edge towards the participant.
        private const float PaperWidthMetres = 0.297f;
        private const float PaperDepthMetres = 0.21f;
        private static readonly Vector3 NearLeft = new Vector3(-0.5f * PaperWidthMetres, 0f, -0.255f);

        private ButtonPress begin = null!;
        private ButtonPress undo = null!;
        private CornerMarks corners = null!;
        private TextMesh text = null!;

        public HapticAlignment Alignment { get; private set; } = null!;

        public string Text => text.text;

        /// <param name="exhibits">The object that moves. The plane y = 0 of its space is the top of the table.</param>
        /// <param name="saveName">The name under which the alignment is kept; empty to keep nothing.</param>
        public static AlignmentStep Create(GameObject exhibits, string saveName, Quaternion facing)
        {
            var alignment = exhibits.AddComponent<HapticAlignment>();
            alignment.SaveName = saveName;
            var step = exhibits.AddComponent<AlignmentStep>();
            step.Alignment = alignment;
            step.corners = CornerMarks.Create(alignment, NearLeft, PaperWidthMetres, PaperDepthMetres);
            step.text = SceneObjects.AddText(Hint, new Vector3(0f, 0.13f, 0.3f), facing);
            step.begin = new ButtonPress("<Keyboard>/a", "<XRController>{LeftHand}/primaryButton");
            step.undo = new ButtonPress("<Keyboard>/u", "<XRController>{LeftHand}/secondaryButton");
            alignment.Changed += step.Show;
            return step;
        }

        private void Update()
        {
            if (begin.IsNew())
            {
                Alignment.Stylus = ActivePenWithForce();
                Alignment.Begin();
            }
            if (undo.IsNew())
            {
                Alignment.Undo();
            }
        }

        private void OnDestroy()
        {
            begin.Dispose();
            undo.Dispose();
        }

        private void Show(HapticAlignment alignment)
        {
            text.text = alignment.IsTaking && alignment.Stylus != null
                ? $"{alignment.Message}\nMark {alignment.PointsTaken + 1} is the paper's {corners.NextCorner} " +
                    "corner; U takes back."
                : alignment.Message;
            foreach (HapticStylus pen in Pens())
            {
                pen.TouchBy = alignment.IsAligned && pen.Force != null
                    ? TouchDecision.MeasuredForce
                    : TouchDecision.Geometry;
            }
        }

        private static HapticStylus? ActivePenWithForce()
        {
            foreach (HapticStylus pen in Pens())
            {
                if (pen.isActiveAndEnabled && pen.Force != null)
                {
                    return pen;
                }
            }
            return null;
        }

        private static HapticStylus[] Pens() =>
            FindObjectsByType<HapticStylus>(FindObjectsInactive.Include, FindObjectsSortMode.None);
    }
}
#endif
