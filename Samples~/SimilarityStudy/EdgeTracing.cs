#nullable enable
using System;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>Which parts of a rectangle's four edges a tip has slid along. In the rectangle's own plane, in metres,
    /// from its centre. No garbage.</summary>
    public sealed class EdgeTracing
    {
        /// <summary>Near, right, far, left.</summary>
        public const int EdgeCount = 4;

        private const int PartsOfAnEdge = 24;

        // A hand that slides at 3 m/s moves so far between two frames of a slow display.
        private const double LongestStepMetres = 0.06;

        private readonly bool[,] traced = new bool[EdgeCount, PartsOfAnEdge];
        private readonly int[] tracedParts = new int[EdgeCount];
        private readonly double width;
        private readonly double depth;
        private readonly double tolerance;
        private readonly int wantedParts;
        private double lastX = double.NaN;
        private double lastZ = double.NaN;

        /// <param name="widthMetres">Along x.</param>
        /// <param name="depthMetres">Along z.</param>
        /// <param name="toleranceMetres">A tip no farther from an edge is on it.</param>
        /// <param name="share">Of an edge that has to be traced, above 0 to 1.</param>
        public EdgeTracing(double widthMetres, double depthMetres, double toleranceMetres, double share)
        {
            width = widthMetres;
            depth = depthMetres;
            tolerance = toleranceMetres;
            wantedParts = Math.Max(1, (int)Math.Ceiling(share * PartsOfAnEdge - 1e-9));
        }

        /// <summary>Every edge is traced.</summary>
        public bool IsComplete => TracedEdges == EdgeCount;

        /// <summary>How many edges are traced.</summary>
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

        /// <param name="edge">0 near, 1 right, 2 far, 3 left.</param>
        public bool IsTraced(int edge) => tracedParts[edge] >= wantedParts;

        /// <summary>Nothing is traced yet.</summary>
        public void Begin()
        {
            Array.Clear(traced, 0, traced.Length);
            Array.Clear(tracedParts, 0, tracedParts.Length);
            Lift();
        }

        /// <summary>The tip left the surface: what comes next is not joined to what was before.</summary>
        public void Lift() => lastX = lastZ = double.NaN;

        /// <summary>The tip touches here.</summary>
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

        /// <summary>-1 beside the edge.</summary>
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
