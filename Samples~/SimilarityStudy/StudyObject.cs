#nullable enable
using UnityEngine;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>One of the two objects that a participant compares. Both look alike, whatever they feel like, and
    /// nothing about them tells the material.</summary>
    public sealed class StudyObject
    {
        private const float MarkMetres = 0.003f;
        private static readonly Color Grey = new Color(0.62f, 0.62f, 0.64f);
        private static readonly Color Bright = new Color(0.95f, 0.85f, 0.2f);

        private readonly GameObject[] marks = new GameObject[EdgeTracing.EdgeCount];

        /// <param name="parent">Moves with the real sample; the plane y = 0 is the top of both objects.</param>
        /// <param name="place">Of the middle of the top, in the parent's frame.</param>
        /// <param name="size">In metres.</param>
        /// <param name="catchMetres">How far above its top the object is already touched.</param>
        public StudyObject(
            string name, Transform parent, Vector3 place, Vector3 size, float catchMetres, EdgeTracing tracing)
        {
            Tracing = tracing;
            Frame = new GameObject(name).transform;
            Frame.SetParent(parent, false);
            Frame.localPosition = place;
            GameObject solid = Build.Solid("Solid", PrimitiveType.Cube, Vector3.zero, size, Grey);
            solid.transform.SetParent(Frame, false);
            solid.transform.localPosition = new Vector3(0f, -0.5f * size.y, 0f);
            var box = solid.GetComponent<BoxCollider>();
            box.size = new Vector3(1f, 1f + catchMetres / size.y, 1f);
            box.center = new Vector3(0f, 0.5f * catchMetres / size.y, 0f);
            Collider = box;
            Renderer = solid.GetComponent<MeshRenderer>();
            Surface = solid.AddComponent<HapticSurface>();
            for (int edge = 0; edge < marks.Length; ++edge)
            {
                marks[edge] = Mark(edge, size);
            }
        }

        /// <summary>The middle of its top.</summary>
        public Transform Frame { get; }

        /// <summary>What the pen touches.</summary>
        public Collider Collider { get; }

        /// <summary>What the participant sees.</summary>
        public MeshRenderer Renderer { get; }

        /// <summary>What the object feels like.</summary>
        public HapticSurface Surface { get; }

        /// <summary>Which edges were traced.</summary>
        public EdgeTracing Tracing { get; }

        /// <summary>Follows a pen that touches this object.</summary>
        public void Trace(HapticStylus pen)
        {
            if (!pen.IsTouching || !ReferenceEquals(pen.Contact.Collider, Collider))
            {
                Tracing.Lift();
                return;
            }
            Vector3 place = Frame.InverseTransformPoint(pen.Contact.Point);
            Tracing.Add(place.x, place.z);
        }

        /// <summary>Shows which edges are still to be traced, or none.</summary>
        public void ShowEdges(bool isTraced)
        {
            for (int edge = 0; edge < marks.Length; ++edge)
            {
                bool isShown = isTraced && !Tracing.IsTraced(edge);
                if (isShown != marks[edge].activeSelf)
                {
                    marks[edge].SetActive(isShown);
                }
            }
        }

        private GameObject Mark(int edge, Vector3 size)
        {
            bool isAlongX = edge == 0 || edge == 2;
            float side = edge == 0 || edge == 3 ? -0.5f : 0.5f;
            Vector3 place = isAlongX ? new Vector3(0f, 0f, side * size.z) : new Vector3(side * size.x, 0f, 0f);
            Vector3 extent = isAlongX
                ? new Vector3(size.x, MarkMetres, MarkMetres)
                : new Vector3(MarkMetres, MarkMetres, size.z);
            GameObject mark = Build.Solid("Edge", PrimitiveType.Cube, Vector3.zero, extent, Bright);
            mark.GetComponent<Collider>().enabled = false;
            mark.transform.SetParent(Frame, false);
            mark.transform.localPosition = place;
            mark.SetActive(false);
            return mark;
        }
    }
}
