#nullable enable
using System;
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
        public Collider Collider { get; }
        public MeshRenderer Renderer { get; }
        public HapticSurface Surface { get; }
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

    /// <summary>Records which parts of a rectangle's four edges a tip has slid along. Positions are in the plane of the
    /// rectangle, in metres from its centre. Allocates nothing.</summary>
    public sealed class EdgeTracing
    {
        /// <summary>The number of edges: near, right, far, left.</summary>
        public const int EdgeCount = 4;

        private const int PartsOfAnEdge = 24;

        // A hand that slides at 3 m/s moves this far between two frames at 50 Hz.
        private const double LongestStepMetres = 0.06;

        private readonly bool[,] traced = new bool[EdgeCount, PartsOfAnEdge];
        private readonly int[] tracedParts = new int[EdgeCount];
        private readonly double width;
        private readonly double depth;
        private readonly double tolerance;
        private readonly int requiredParts;
        private double lastX = double.NaN;
        private double lastZ = double.NaN;

        /// <param name="widthMetres">The extent along x.</param>
        /// <param name="depthMetres">The extent along z.</param>
        /// <param name="toleranceMetres">The largest distance from an edge at which the tip is on it.</param>
        /// <param name="share">The share of an edge that has to be traced, above 0 to 1.</param>
        public EdgeTracing(double widthMetres, double depthMetres, double toleranceMetres, double share)
        {
            width = widthMetres;
            depth = depthMetres;
            tolerance = toleranceMetres;
            requiredParts = Math.Max(1, (int)Math.Ceiling(share * PartsOfAnEdge - 1e-9));
        }

        public bool IsComplete => TracedEdges == EdgeCount;

        public int TracedEdges
        {
            get
            {
                int count = 0;
                for (int edge = 0; edge < EdgeCount; ++edge)
                {
                    count += IsTraced(edge) ? 1 : 0;
                }
                return count;
            }
        }

        /// <summary>Whether an edge is traced.</summary>
        /// <param name="edge">0 near, 1 right, 2 far, 3 left.</param>
        public bool IsTraced(int edge) => tracedParts[edge] >= requiredParts;

        /// <summary>Starts anew, with no edge traced.</summary>
        public void Begin()
        {
            Array.Clear(traced, 0, traced.Length);
            Array.Clear(tracedParts, 0, tracedParts.Length);
            Lift();
        }

        /// <summary>Ends a stroke: the next position is not connected with the one before.</summary>
        public void Lift() => lastX = lastZ = double.NaN;

        /// <summary>Adds the position of a touching tip, and everything between it and the one before.</summary>
        public void Add(double x, double z)
        {
            double step = Math.Max(Math.Abs(x - lastX), Math.Abs(z - lastZ));
            bool isJoined = step <= LongestStepMetres;
            for (int edge = 0; edge < EdgeCount; ++edge)
            {
                int here = PartAt(edge, x, z);
                if (here < 0)
                {
                    continue;
                }
                int before = isJoined ? PartAt(edge, lastX, lastZ) : here;
                before = before < 0 ? here : before;
                for (int part = Math.Min(before, here); part <= Math.Max(before, here); ++part)
                {
                    tracedParts[edge] += traced[edge, part] ? 0 : 1;
                    traced[edge, part] = true;
                }
            }
            lastX = x;
            lastZ = z;
        }

        /// <summary>The part of an edge at a position; -1 when the position is not on the edge.</summary>
        private int PartAt(int edge, double x, double z)
        {
            bool isAlongX = edge == 0 || edge == 2;
            double side = edge == 0 || edge == 3 ? -0.5 : 0.5;
            double across = isAlongX ? z - side * depth : x - side * width;
            double length = isAlongX ? width : depth;
            double along = (isAlongX ? x : z) + 0.5 * length;
            bool isOn = Math.Abs(across) <= tolerance && along >= -tolerance && along <= length + tolerance;
            return isOn ? Math.Max(0, Math.Min(PartsOfAnEdge - 1, (int)(PartsOfAnEdge * along / length))) : -1;
        }
    }
}
