#nullable enable
using System;

namespace HaptoFlow.Numerics
{
    /// <summary>Rules about numbers that everything in contact shares.</summary>
    internal static class Vectors
    {
        /// <summary>Beyond this a coordinate, in metres or seconds, counts as damaged: its square must stay finite.
        /// </summary>
        public const double MaximumCoordinate = 1e12;

        public static bool IsFinite(double value) => !double.IsNaN(value) && !double.IsInfinity(value);

        /// <summary>Finite and not beyond <see cref="MaximumCoordinate"/>.</summary>
        public static bool IsUsable(double value) => Math.Abs(value) <= MaximumCoordinate;

        /// <summary>Finite and not beyond <see cref="MaximumCoordinate"/>.</summary>
        public static bool IsUsable(Double3 vector) => IsUsable(vector.X) && IsUsable(vector.Y) && IsUsable(vector.Z);

        /// <summary>The vector at length 1; the fallback where it has no direction (zero or not finite). Right from
        /// 1e-300 to 1e300.</summary>
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

        /// <summary>A unit vector at right angles to a unit vector, the same for the same input.</summary>
        public static Double3 AnyPerpendicular(Double3 unit)
        {
            Double3 size = unit.Absolute;
            Double3 least = Double3.Forward;
            if (size.Y <= size.X && size.Y <= size.Z)
            {
                least = Double3.Up;
            }
            else if (size.X <= size.Z)
            {
                least = Double3.Right;
            }
            return UnitOr(least - unit * Double3.Dot(least, unit), Double3.Right);
        }

        public static double Clamp(double value, double lowest, double highest) =>
            value < lowest ? lowest : value > highest ? highest : value;
    }
}
