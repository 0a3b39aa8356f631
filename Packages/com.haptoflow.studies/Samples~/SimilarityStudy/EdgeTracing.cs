#nullable enable
using System;

namespace HaptoFlow.Samples.SimilarityStudy
{
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

        /// <summary>Whether every edge is traced.</summary>
        public bool IsComplete => TracedEdges == EdgeCount;

        /// <summary>The number of traced edges.</summary>
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
