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

        public SurfacePoint(Double3 pointMetres, Double3 normal, double signedDistanceMetres) =>
            (PointMetres, Normal, SignedDistanceMetres) = (pointMetres, normal, signedDistanceMetres);
    }

    /// <summary>Closest points of shapes with a formula. Points are in the shape's local frame and usable; results are
    /// always finite with a unit normal, also on an edge, a corner, the centre of a sphere or the axis of a capsule
    /// (where the previous normal is used, else +y adapted to the shape).</summary>
    internal static class Shapes
    {
        /// <summary>A box centred on the origin.</summary>
        /// <param name="sizeMetres">Edge lengths, all above zero.</param>
        /// <param name="previousNormal">Local normal of the previous frame's contact with the same shape.</param>
        /// <param name="faceMarginMetres">Inside, another face is taken only when it is nearer by this distance (at
        /// most a tenth of the half thickness).</param>
        public static SurfacePoint OnBox(
            Double3 sizeMetres, Double3 point, Double3? previousNormal, double faceMarginMetres)
        {
            Double3 half = 0.5 * sizeMetres;
            Double3 nearest = Double3.Clamp(point, -half, half);
            double distance = Double3.Distance(point, nearest);
            // At smaller distances the direction from the surface to the point is rounding error.
            double onSurface = 1e-13 * half.Largest;
            return distance <= onSurface
                ? InsideBox(half, nearest, previousNormal, faceMarginMetres)
                : new SurfacePoint(nearest, Vectors.UnitOr(point - nearest, Double3.Up), distance);
        }

        /// <summary>A sphere centred on the origin.</summary>
        public static SurfacePoint OnSphere(double radiusMetres, Double3 point, Double3? previousNormal) =>
            AroundCore(Double3.Zero, radiusMetres, point, previousNormal ?? Double3.Up);

        /// <summary>A capsule along local y, centred on the origin. The height includes both caps; a height below two
        /// radii gives a sphere.</summary>
        public static SurfacePoint OnCapsule(
            double radiusMetres, double heightMetres, Double3 point, Double3? previousNormal)
        {
            double half = Math.Max(0.0, 0.5 * heightMetres - radiusMetres);
            var core = new Double3(0.0, Vectors.Clamp(point.Y, -half, half), 0.0);
            Double3 fallback = half > 0.0 ? Double3.Right : Double3.Up;
            if (previousNormal.HasValue)
            {
                Double3 previous = previousNormal.Value;
                fallback = half > 0.0 ? Vectors.UnitOr(previous.With(1, 0.0), fallback) : previous;
            }
            return AroundCore(core, radiusMetres, point, fallback);
        }

        /// <summary>The half-space below local y = 0.</summary>
        public static SurfacePoint OnPlane(Double3 point) => new SurfacePoint(point.With(1, 0.0), Double3.Up, point.Y);

        private static SurfacePoint InsideBox(
            Double3 half, Double3 point, Double3? previousNormal, double faceMarginMetres)
        {
            int axis = 1;
            double side = SideOf(point, 1);
            for (int candidate = 0; candidate < 3; candidate += 2)
            {
                double candidateSide = SideOf(point, candidate);
                if (DepthBelow(candidate, candidateSide, point, half) < DepthBelow(axis, side, point, half))
                {
                    axis = candidate;
                    side = candidateSide;
                }
            }
            if (previousNormal.HasValue)
            {
                int kept = FaceAlong(previousNormal.Value);
                double keptSide = SideOf(previousNormal.Value, kept);
                double margin = Math.Min(faceMarginMetres, 0.1 * half.Smallest);
                if (DepthBelow(kept, keptSide, point, half) <= DepthBelow(axis, side, point, half) + margin)
                {
                    axis = kept;
                    side = keptSide;
                }
            }
            return new SurfacePoint(
                point.With(axis, side * half[axis]), Double3.Zero.With(axis, side),
                -DepthBelow(axis, side, point, half));
        }

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
        private static SurfacePoint AroundCore(Double3 core, double radius, Double3 point, Double3 fallback)
        {
            Double3 offset = point - core;
            double distance = offset.Length;
            Double3 normal = distance > 1e-13 * radius ? Vectors.UnitOr(offset, fallback) : fallback;
            return new SurfacePoint(core + radius * normal, normal, distance - radius);
        }
    }
}
