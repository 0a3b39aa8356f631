#nullable enable
using System;
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>The point of a surface closest to a given point, in the shape's local frame, in metres.</summary>
    internal readonly struct SurfacePoint
    {
        public readonly Double3 PointMetres;

        /// <summary>Unit normal out of the material.</summary>
        public readonly Double3 Normal;

        /// <summary>Signed distance, negative inside the material.</summary>
        public readonly double SignedDistanceMetres;

        /// <summary>For a point that went through the shape: its distance from the shape's far side, or from an open
        /// mesh. <see cref="SignedDistanceMetres"/> is then measured from the face that was entered. 0
        /// otherwise.</summary>
        public readonly double BeyondMetres;

        public SurfacePoint(
            Double3 pointMetres, Double3 normal, double signedDistanceMetres, double beyondMetres = 0.0) =>
            (PointMetres, Normal, SignedDistanceMetres, BeyondMetres) =
            (pointMetres, normal, signedDistanceMetres, beyondMetres);
    }

    /// <summary>Where the tip's path first goes into a surface, in the shape's local frame.</summary>
    internal readonly struct SurfaceEntry
    {
        public readonly Double3 PointMetres;

        /// <summary>Unit normal out of the face.</summary>
        public readonly Double3 Normal;

        /// <summary>The part of the path before the entry, 0 to 1.</summary>
        public readonly double Share;

        public SurfaceEntry(Double3 pointMetres, Double3 normal, double share) =>
            (PointMetres, Normal, Share) = (pointMetres, normal, share);

        /// <summary>The contact of a tip that came out again within the frame: where it went in.</summary>
        public SurfacePoint PassedBy(Double3 tip) => new SurfacePoint(
            PointMetres, Normal, Double3.Dot(tip - PointMetres, Normal), double.PositiveInfinity);

        public SurfaceEntry MovedBy(Double3 metres) => new SurfaceEntry(PointMetres + metres, Normal, Share);
    }

    /// <summary>The face of a surface that the tip is held by, so that it does not change for the nearest one at every
    /// depth.</summary>
    internal readonly struct HeldFace
    {
        /// <summary>A face that was entered is held up to this depth below it.</summary>
        public const double MaximumDepthMetres = 0.05;

        /// <summary>Normals closer than this cosine (45 degrees) are of the same side.</summary>
        public const double SameSideCosine = 0.7071;

        /// <summary>Local normal of the face that was entered, or of the last contact with the surface. A face that is
        /// nearer by the margin replaces it.</summary>
        public readonly Double3? Normal;

        /// <summary>True if the touch began on this surface, or begins. The face that was entered is then kept, however
        /// deep the point is: the opposite face never replaces it. A neighbouring face does, except on a plate entered
        /// through its broad side, where the shape is thinner below the kept face than below the neighbour.</summary>
        public readonly bool CameFromOutside;

        public readonly double MarginMetres;

        public readonly bool IsTouched;

        public HeldFace(Double3? normal, bool cameFromOutside, double marginMetres, bool isTouched) =>
            (Normal, CameFromOutside, MarginMetres, IsTouched) =
            (normal, cameFromOutside, marginMetres, isTouched);

        /// <summary>The same face for lengths in another metre.</summary>
        public HeldFace Scaled(double scale) =>
            new HeldFace(Normal, CameFromOutside, scale * MarginMetres, IsTouched);

        /// <summary>True where the held face stays against those that are nearer.</summary>
        public bool Holds(double depthMetres) =>
            Normal.HasValue && CameFromOutside && depthMetres <= MaximumDepthMetres;

        /// <summary>The face by which the path went in. Only what is touched already has a face to stay on.</summary>
        public HeldFace EnteredBy(in SurfaceEntry entry) =>
            new HeldFace(entry.Normal, CameFromOutside, IsTouched ? MarginMetres : 0.0, IsTouched);
    }

    /// <summary>Closest points of shapes with a formula. Points are in the shape's local frame and usable; results are
    /// always finite with a unit normal, also on an edge, a corner, the centre of a sphere or the axis of a capsule
    /// (where the previous normal is used, else +y adapted to the shape).</summary>
    internal static class Shapes
    {
        /// <summary>A box centred on the origin.</summary>
        /// <param name="sizeMetres">Edge lengths, all above zero.</param>
        public static SurfacePoint OnBox(Double3 sizeMetres, Double3 point, in HeldFace held)
        {
            Double3 half = 0.5 * sizeMetres;
            Double3 nearest = Double3.Clamp(point, -half, half);
            double distance = Double3.Distance(point, nearest);
            // At smaller distances the direction from the surface to the point is rounding error.
            double onSurface = 1e-13 * half.Largest;
            if (distance <= onSurface)
            {
                return InsideBox(half, nearest, held);
            }
            return IsThroughBox(half, point, held, out int axis, out double side)
                ? BelowFace(axis, side, point, half, distance)
                : new SurfacePoint(nearest, Vectors.UnitOr(point - nearest, Double3.Up), distance);
        }

        /// <summary>A capsule along local y, centred on the origin. The height includes both caps; a height below two
        /// radii gives a sphere.</summary>
        public static SurfacePoint OnCapsule(
            double radiusMetres, double heightMetres, Double3 point, in HeldFace held)
        {
            double half = Math.Max(0.0, 0.5 * heightMetres - radiusMetres);
            Double3 core = CoreOf(point, half);
            Double3 fallback = half > 0.0 ? Double3.Right : Double3.Up;
            if (held.Normal.HasValue)
            {
                Double3 previous = held.Normal.Value;
                fallback = half > 0.0 ? Vectors.UnitOr(previous.With(1, 0.0), fallback) : previous;
            }
            return AroundCore(core, radiusMetres, point, fallback, held);
        }

        /// <summary>Where a straight path first enters a box from outside.</summary>
        public static SurfaceEntry? EntryOfBox(Double3 sizeMetres, Double3 from, Double3 to)
        {
            Double3 half = 0.5 * sizeMetres;
            Double3 path = to - from;
            double entering = double.NegativeInfinity;
            double leaving = double.PositiveInfinity;
            int axis = 1;
            for (int step = 0; step < 3; ++step)
            {
                int each = step == 0 ? 1 : step == 1 ? 0 : 2;
                if (path[each] == 0.0)
                {
                    if (Math.Abs(from[each]) > half[each])
                    {
                        return null;
                    }
                    continue;
                }
                double near = path[each] > 0.0 ? -half[each] : half[each];
                double share = (near - from[each]) / path[each];
                if (share > entering)
                {
                    entering = share;
                    axis = each;
                }
                leaving = Math.Min(leaving, (-near - from[each]) / path[each]);
            }
            if (!(entering >= 0.0 && entering <= 1.0 && entering <= leaving))
            {
                return null;
            }
            double side = path[axis] > 0.0 ? -1.0 : 1.0;
            return new SurfaceEntry(
                (from + path * entering).With(axis, side * half[axis]), Double3.Zero.With(axis, side), entering);
        }

        /// <summary>Where a straight path first enters a capsule along local y from outside.</summary>
        public static SurfaceEntry? EntryOfCapsule(double radiusMetres, double heightMetres, Double3 from, Double3 to)
        {
            double half = Math.Max(0.0, 0.5 * heightMetres - radiusMetres);
            Double3 path = to - from;
            if (Double3.Distance(from, CoreOf(from, half)) < radiusMetres)
            {
                return null;
            }
            double first = double.PositiveInfinity;
            double side = ShareAtRadius(from.With(1, 0.0), path.With(1, 0.0), radiusMetres);
            if (side >= 0.0 && Math.Abs(from.Y + side * path.Y) <= half)
            {
                first = side;
            }
            for (int cap = -1; cap <= 1; cap += 2)
            {
                double share = ShareAtRadius(from - new Double3(0.0, cap * half, 0.0), path, radiusMetres);
                if (share >= 0.0 && share < first && Math.Abs(from.Y + share * path.Y) >= half)
                {
                    first = share;
                }
            }
            if (!(first <= 1.0))
            {
                return null;
            }
            Double3 point = from + path * first;
            return new SurfaceEntry(point, Vectors.UnitOr(point - CoreOf(point, half), Double3.Up), first);
        }

        private static Double3 CoreOf(Double3 point, double half) =>
            new Double3(0.0, Vectors.Clamp(point.Y, -half, half), 0.0);

        /// <summary>The first share of a path at which it is a radius away from the origin, coming nearer.</summary>
        private static double ShareAtRadius(Double3 from, Double3 path, double radius)
        {
            double square = Double3.Dot(path, path);
            double towards = Double3.Dot(from, path);
            double root = towards * towards - square * (Double3.Dot(from, from) - radius * radius);
            return root < 0.0 || square <= 0.0 ? double.PositiveInfinity : (-towards - Math.Sqrt(root)) / square;
        }

        private static SurfacePoint InsideBox(Double3 half, Double3 point, in HeldFace held)
        {
            if (!held.Normal.HasValue)
            {
                int nearestAxis = Nearer(Nearer(1, 0, point, half), 2, point, half);
                return BelowFace(nearestAxis, SideOf(point, nearestAxis), point, half, 0.0);
            }
            int kept = FaceAlong(held.Normal.Value);
            double keptSide = SideOf(held.Normal.Value, kept);
            double keptDepth = DepthBelow(kept, keptSide, point, half);
            int beside = Nearer(kept == 1 ? 0 : 1, kept == 2 ? 0 : 2, point, half);
            bool holds = held.Holds(keptDepth);
            int nearest = holds ? beside : Nearer(kept, beside, point, half);
            bool isThinner = holds && half[kept] < half[beside];
            bool isNear = keptDepth <= DepthBelow(nearest, SideOf(point, nearest), point, half) + held.MarginMetres;
            return isThinner || isNear
                ? BelowFace(kept, keptSide, point, half, 0.0)
                : BelowFace(nearest, SideOf(point, nearest), point, half, 0.0);
        }

        /// <summary>True for a point that went through the box and is straight below the face that holds it.</summary>
        private static bool IsThroughBox(
            Double3 half, Double3 point, in HeldFace held, out int axis, out double side)
        {
            axis = 1;
            side = 1.0;
            if (!held.Normal.HasValue)
            {
                return false;
            }
            axis = FaceAlong(held.Normal.Value);
            side = SideOf(held.Normal.Value, axis);
            for (int other = 0; other < 3; ++other)
            {
                if (other != axis && Math.Abs(point[other]) > half[other])
                {
                    return false;
                }
            }
            double depth = DepthBelow(axis, side, point, half);
            return depth > half[axis] && held.Holds(depth);
        }

        private static SurfacePoint BelowFace(
            int axis, double side, Double3 point, Double3 half, double beyondMetres) => new SurfacePoint(
            point.With(axis, side * half[axis]), Double3.Zero.With(axis, side),
            -DepthBelow(axis, side, point, half), beyondMetres);

        /// <summary>The axis whose nearer face is closer; the first of two that are equally close.</summary>
        private static int Nearer(int one, int other, Double3 point, Double3 half) =>
            DepthBelow(other, SideOf(point, other), point, half) < DepthBelow(one, SideOf(point, one), point, half)
                ? other
                : one;

        private static double SideOf(Double3 vector, int axis) => vector[axis] < 0.0 ? -1.0 : 1.0;

        private static double DepthBelow(int axis, double side, Double3 point, Double3 half) =>
            half[axis] - side * point[axis];

        private static int FaceAlong(Double3 normal)
        {
            Double3 size = normal.Absolute;
            if (size.Y >= size.X && size.Y >= size.Z)
            {
                return 1;
            }
            return size.Z > size.X ? 2 : 0;
        }

        /// <summary>Sphere and capsule: a ball around the closest point of the shape's core.</summary>
        private static SurfacePoint AroundCore(
            Double3 core, double radius, Double3 point, Double3 fallback, in HeldFace held)
        {
            Double3 offset = point - core;
            double distance = offset.Length;
            if (held.Normal.HasValue)
            {
                Double3 side = held.Normal.Value;
                double height = Double3.Dot(offset, side);
                // Near the core and past it the nearest side changes at the slightest movement.
                bool isPast = height < 0.0 || distance < 0.5 * radius;
                if (isPast && (offset - side * height).Length <= radius && held.Holds(radius - height))
                {
                    return new SurfacePoint(
                        core + radius * side, side, height - radius, Math.Max(0.0, distance - radius));
                }
            }
            Double3 normal = distance > 1e-13 * radius ? Vectors.UnitOr(offset, fallback) : fallback;
            return new SurfacePoint(core + radius * normal, normal, distance - radius);
        }
    }
}
