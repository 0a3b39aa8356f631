#nullable enable
using UnityEngine;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>Puts the pair of objects onto the real sample: the pen touches three corners of the sample's top, and
    /// the left object lies there. Main thread.</summary>
    public sealed class SampleAlignment : MonoBehaviour
    {
        private static readonly Vector3 MarkSize = new Vector3(0.008f, 0.008f, 0.008f);
        private static readonly string[] Corners = { "near left", "near right", "far left" };

        private readonly GameObject[] marks = new GameObject[Corners.Length];
        private StudyRig rig = null!;
        private bool forceDecides;

        /// <summary>What takes the points and moves the objects.</summary>
        public HapticAlignment Alignment { get; private set; } = null!;

        /// <summary>What to do next, for the operator.</summary>
        public string Text { get; private set; } = "";

        /// <param name="pair">What moves; the plane y = 0 of its own frame is the top of both objects.</param>
        /// <param name="saveName">The place is kept under this name; empty to keep nothing.</param>
        public static SampleAlignment Create(GameObject pair, StudyRig rig, string saveName)
        {
            var step = pair.AddComponent<SampleAlignment>();
            step.rig = rig;
            step.Alignment = pair.AddComponent<HapticAlignment>();
            step.Alignment.SaveName = saveName;
            step.Alignment.Changed += step.Show;
            return step;
        }

        /// <summary>Which corners are touched.</summary>
        /// <param name="size">Of the sample, in metres.</param>
        /// <param name="hasPlate">A plate lies under the virtual object: a pen's measured force decides what it
        /// touches.</param>
        public void SetSample(Vector3 size, bool hasPlate)
        {
            forceDecides = hasPlate;
            var nearLeft = new Vector3(-0.5f * size.x, 0f, -0.5f * size.z);
            Alignment.SetMarks(nearLeft, nearLeft + size.x * Vector3.right, nearLeft + size.z * Vector3.forward);
            for (int index = 0; index < marks.Length; ++index)
            {
                marks[index] = Build.Solid("Mark " + Corners[index], PrimitiveType.Sphere,
                    Alignment.MarkPosition(index), MarkSize, new Color(0.95f, 0.2f, 0.2f));
                marks[index].GetComponent<Collider>().enabled = false;
                marks[index].transform.SetParent(transform, true);
                marks[index].SetActive(false);
            }
        }

        /// <summary>Starts taking points with the pen in use.</summary>
        public void Begin()
        {
            Alignment.Stylus = rig.Pen;
            // A force without a known place would touch wherever the pen is.
            rig.Pen.TouchBy = TouchDecision.Geometry;
            Alignment.Begin();
        }

        /// <summary>Takes the place of the tip as a point: for pens that measure no force.</summary>
        public void TakePoint()
        {
            if (Alignment.IsTaking && Alignment.Stylus != null)
            {
                Alignment.TakePoint();
            }
        }

        private void Show(HapticAlignment alignment)
        {
            int next = alignment.PointsTaken;
            Text = alignment.IsTaking ? $"{alignment.Message} It is the {Corners[next]} corner." : alignment.Message;
            for (int index = 0; index < marks.Length; ++index)
            {
                marks[index].SetActive(alignment.IsTaking && index == next);
            }
        }

        private void Update()
        {
            HapticStylus pen = rig.Pen;
            bool byForce = forceDecides && Alignment.IsAligned && !Alignment.IsTaking && pen.Force != null;
            pen.TouchBy = byForce ? TouchDecision.MeasuredForce : TouchDecision.Geometry;
        }
    }
}
