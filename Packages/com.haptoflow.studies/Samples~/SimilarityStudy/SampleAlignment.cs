#nullable enable
using UnityEngine;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>Aligns the pair of objects with the real sample: the pen touches three corners of the sample's top, and
    /// the left object moves there. Main thread.</summary>
    public sealed class SampleAlignment : MonoBehaviour
    {
        private const float Left = 660f;
        private const float Top = 10f;
        private const float Width = 150f;
        private const float Height = 33f;

        private XrRig rig = null!;
        private CornerMarks? corners;
        private bool forceDecides;

        public HapticAlignment Alignment { get; private set; } = null!;
        public string Text { get; private set; } = "";

        /// <summary>Whether the operator sees the buttons of the alignment. They are drawn with Unity's immediate mode,
        /// which the screen shows and the headset does not.</summary>
        public bool HasButtons { get; set; }

        /// <param name="pair">The object that moves. The plane y = 0 of its space is the top of both objects.</param>
        /// <param name="saveName">The name under which the alignment is kept; empty to keep nothing.</param>
        public static SampleAlignment Create(GameObject pair, XrRig rig, string saveName)
        {
            var step = pair.AddComponent<SampleAlignment>();
            step.rig = rig;
            step.Alignment = pair.AddComponent<HapticAlignment>();
            step.Alignment.SaveName = saveName;
            step.Alignment.Changed += step.Show;
            return step;
        }

        /// <summary>Sets which corners the pen has to touch.</summary>
        /// <param name="size">The size of the sample, in metres.</param>
        /// <param name="hasPlate">Whether a plate lies under the virtual object. If so, the force that a pen measures
        /// decides when it touches.</param>
        public void SetSample(Vector3 size, bool hasPlate)
        {
            forceDecides = hasPlate;
            corners = CornerMarks.Create(Alignment, new Vector3(-0.5f * size.x, 0f, -0.5f * size.z), size.x, size.z);
        }

        public void Begin()
        {
            HapticStylus pen = rig.PenInUse!;
            Alignment.Stylus = pen;
            // Before the alignment, a measured force would count as a touch wherever the pen is.
            pen.TouchBy = TouchDecision.Geometry;
            Alignment.Begin();
        }

        /// <summary>Takes the position of the tip as a point, for pens that measure no force.</summary>
        public void TakePoint()
        {
            if (Alignment.IsTaking && Alignment.Stylus != null)
            {
                Alignment.TakePoint();
            }
        }

        private void Show(HapticAlignment alignment) => Text = alignment.IsTaking && corners != null
            ? $"{alignment.Message} It is the {corners.NextCorner} corner."
            : alignment.Message;

        private void OnGUI()
        {
            if (!HasButtons)
            {
                return;
            }
            if (!Alignment.IsTaking)
            {
                if (Button(0, "Align"))
                {
                    Begin();
                }
            }
            else if (Button(0, "Take point"))
            {
                TakePoint();
            }
            if (Button(1, "Take back"))
            {
                Alignment.Undo();
            }
        }

        private static bool Button(int row, string text) =>
            GUI.Button(new Rect(Left, Top + 1.2f * row * Height, Width, Height), text);

        private void Update()
        {
            HapticStylus pen = rig.PenInUse!;
            bool byForce = forceDecides && Alignment.IsAligned && !Alignment.IsTaking && pen.Force != null;
            pen.TouchBy = byForce ? TouchDecision.MeasuredForce : TouchDecision.Geometry;
        }
    }
}
