#nullable enable
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
using UnityEngine;

namespace HaptoFlow.Samples.StylusTracing
{
    /// <summary>Puts the sample's table onto a real one: a sheet of A4 paper lies there, and the pen touches three of
    /// its corners. From then on pens that measure their tip force touch by it.</summary>
    public sealed class AlignmentStep : MonoBehaviour
    {
        private const string Hint = "A, or the left hand's first button: put this table onto a real one";
        private const float WidthMetres = 0.297f;
        private const float DepthMetres = 0.21f;
        private static readonly Vector3 NearLeft = new Vector3(-0.5f * WidthMetres, 0f, -0.255f);
        private static readonly Vector3 MarkSize = new Vector3(0.008f, 0.008f, 0.008f);
        private static readonly string[] Corners = { "near left", "near right", "far left" };

        private readonly GameObject[] marks = new GameObject[Corners.Length];
        private ButtonPress begin = null!;
        private ButtonPress undo = null!;
        private TextMesh text = null!;

        /// <summary>What takes the points and moves the table.</summary>
        public HapticAlignment Alignment { get; private set; } = null!;

        /// <summary>The text that tells the next step.</summary>
        public string Text => text.text;

        /// <param name="exhibits">What moves; the plane y = 0 of its own frame is the top of the table.</param>
        /// <param name="saveName">The table's place is kept under this name; empty to keep nothing.</param>
        public static AlignmentStep Create(GameObject exhibits, string saveName, Quaternion facing)
        {
            var alignment = exhibits.AddComponent<HapticAlignment>();
            alignment.SaveName = saveName;
            alignment.SetMarks(
                NearLeft, NearLeft + WidthMetres * Vector3.right, NearLeft + DepthMetres * Vector3.forward);
            var step = exhibits.AddComponent<AlignmentStep>();
            step.Alignment = alignment;
            step.text = Build.Text(Hint, new Vector3(0f, 0.13f, 0.3f), facing);
            step.begin = new ButtonPress("<Keyboard>/a", "<XRController>{LeftHand}/primaryButton");
            step.undo = new ButtonPress("<Keyboard>/u", "<XRController>{LeftHand}/secondaryButton");
            step.MakeMarks();
            alignment.Changed += step.Show;
            return step;
        }

        private void MakeMarks()
        {
            for (int index = 0; index < marks.Length; ++index)
            {
                marks[index] = Build.Solid("Mark " + Corners[index], PrimitiveType.Sphere,
                    Alignment.MarkPosition(index), MarkSize, new Color(0.95f, 0.2f, 0.2f));
                marks[index].GetComponent<Collider>().enabled = false;
                marks[index].transform.SetParent(transform, true);
                marks[index].SetActive(false);
            }
        }

        private void Update()
        {
            if (begin.IsNew())
            {
                Alignment.Stylus = PenWithForce();
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
            int next = alignment.PointsTaken;
            text.text = alignment.IsTaking && alignment.Stylus != null
                ? $"{alignment.Message}\nMark {next + 1} is the paper's {Corners[next]} corner; U takes back."
                : alignment.Message;
            for (int index = 0; index < marks.Length; ++index)
            {
                marks[index].SetActive(alignment.IsTaking && index == next);
            }
            foreach (HapticStylus pen in Pens())
            {
                pen.TouchBy = alignment.IsAligned && pen.Force != null
                    ? TouchDecision.MeasuredForce
                    : TouchDecision.Geometry;
            }
        }

        /// <summary>The pen in use that measures its tip force; null where there is none.</summary>
        private static HapticStylus? PenWithForce()
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
