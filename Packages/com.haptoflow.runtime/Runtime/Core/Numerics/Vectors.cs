#nullable enable
using System;

namespace HaptoFlow.Numerics
{
    /// <summary>Checks and vector helpers of the contact model.</summary>
    internal static class Vectors
    {
        /// <summary>Largest usable coordinate, in metres or seconds, so that its square stays finite.</summary>
        public const double MaximumCoordinate = 1e12;

        public static bool IsFinite(double value) => !double.IsNaN(value) && !double.IsInfinity(value);

        /// <summary>Finite and not beyond <see cref="MaximumCoordinate"/>.</summary>
        public static bool IsUsable(double value) => Math.Abs(value) <= MaximumCoordinate;

        /// <summary>Finite and not beyond <see cref="MaximumCoordinate"/>.</summary>
        public static bool IsUsable(Double3 vector) => IsUsable(vector.X) && IsUsable(vector.Y) && IsUsable(vector.Z);

        /// <summary>The vector at length 1; the fallback where it is zero or not finite. Exact for lengths from 1e-300
        /// to 1e300.</summary>
        public static Double3 UnitOr(Double3 vector, Double3 fallback)
        {
            if (!IsFinite(vector.X) || !IsFinite(vector.Y) || !IsFinite(vector.Z))
            {
                return fallback;
            }
            double largest = vector.Absolute.Largest;
            if (!(largest > 1e-300))
            {
                return fallback;
            }
            Double3 scaled = vector / largest;
            return scaled / scaled.Length;
        }

        /// <summary>A unit vector perpendicular to a unit vector; deterministic.</summary>
        public static Double3 AnyPerpendicular(Double3 unit)
        {
            Double3 size = unit.Absolute;
            Double3 axis = Double3.Forward;
            if (size.Y <= size.X && size.Y <= size.Z)
            {
                axis = Double3.Up;
            }
            else if (size.X <= size.Z)
            {
                axis = Double3.Right;
            }
            return UnitOr(axis - unit * Double3.Dot(axis, unit), Double3.Right);
        }

        public static double Clamp(double value, double lowest, double highest) =>
            value < lowest ? lowest : value > highest ? highest : value;
    }
}
