#nullable enable
using UnityEngine;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>One of the two objects that a participant compares. Both look the same, so that their looks do not
    /// reveal the material.</summary>
    public sealed class StudyObject
    {
        private const float MarkMetres = 0.003f;
        internal static readonly Color Grey = new Color(0.62f, 0.62f, 0.64f);
        private static readonly Color Bright = new Color(0.95f, 0.85f, 0.2f);

        private readonly GameObject[] marks = new GameObject[EdgeTracing.EdgeCount];

        /// <param name="parent">The object that the alignment moves. The plane y = 0 of its local space is the top of
        /// both objects.</param>
        /// <param name="place">The middle of the top, in the parent's local space.</param>
        /// <param name="size">The size, in metres.</param>
        /// <param name="catchMetres">The height above the top at which the tip already counts as touching.</param>
        public StudyObject(
            string name, Transform parent, Vector3 place, Vector3 size, float catchMetres, EdgeTracing tracing)
        {
            Tracing = tracing;
            Frame = new GameObject(name).transform;
            Frame.SetParent(parent, false);
            Frame.localPosition = place;
            GameObject solid = SceneObjects.AddSolid("Solid", PrimitiveType.Cube, Vector3.zero, size, Grey);
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
                marks[edge] = AddEdge(edge, size);
            }
        }

        /// <summary>The local space whose origin is the middle of the top.</summary>
        public Transform Frame { get; }

        /// <summary>The collider that the pen touches.</summary>
        public Collider Collider { get; }

        /// <summary>The renderer of the object.</summary>
        public MeshRenderer Renderer { get; }

        /// <summary>The surface with the material of the object.</summary>
        public HapticSurface Surface { get; }

        /// <summary>The edges that the pen has traced.</summary>
        public EdgeTracing Tracing { get; }

        /// <summary>Records where a pen touches this object. Call it once a frame.</summary>
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

        /// <summary>Shows the edges that are still to be traced.</summary>
        public void ShowEdges(bool isShown)
        {
            for (int edge = 0; edge < marks.Length; ++edge)
            {
                bool isMissing = isShown && !Tracing.IsTraced(edge);
                if (isMissing != marks[edge].activeSelf)
                {
                    marks[edge].SetActive(isMissing);
                }
            }
        }

        private GameObject AddEdge(int edge, Vector3 size)
        {
            bool isAlongX = edge == 0 || edge == 2;
            float side = edge == 0 || edge == 3 ? -0.5f : 0.5f;
            Vector3 place = isAlongX ? new Vector3(0f, 0f, side * size.z) : new Vector3(side * size.x, 0f, 0f);
            Vector3 extent = isAlongX
                ? new Vector3(size.x, MarkMetres, MarkMetres)
                : new Vector3(MarkMetres, MarkMetres, size.z);
            GameObject mark = SceneObjects.AddMark("Edge", PrimitiveType.Cube, Vector3.zero, extent, Bright);
            mark.transform.SetParent(Frame, false);
            mark.transform.localPosition = place;
            mark.SetActive(false);
            return mark;
        }
    }
}
