#nullable enable
using System;

namespace HaptoFlow.Numerics
{
    /// <summary>A position or direction in double precision, in Unity's left-handed, y-up frame.</summary>
    /// <remarks>Single precision is not sufficient for contact: at 10 m from the origin its resolution is 1 micrometre,
    /// which is a tenth of a millimetre a second of velocity noise from one frame to the next at 90 Hz.</remarks>
    internal readonly struct Double3 : IEquatable<Double3>
    {
        public readonly double X;
        public readonly double Y;
        public readonly double Z;

        public Double3(double x, double y, double z) => (X, Y, Z) = (x, y, z);

        public static Double3 Zero => default;
        public static Double3 Right => new Double3(1.0, 0.0, 0.0);
        public static Double3 Up => new Double3(0.0, 1.0, 0.0);
        public static Double3 Forward => new Double3(0.0, 0.0, 1.0);

        public double Length => Math.Sqrt(Dot(this, this));
        public Double3 Absolute => new Double3(Math.Abs(X), Math.Abs(Y), Math.Abs(Z));
        public double Largest => Math.Max(X, Math.Max(Y, Z));
        public double Smallest => Math.Min(X, Math.Min(Y, Z));

        /// <summary>Coordinate 0, 1 or 2.</summary>
        public double this[int axis] => axis == 0 ? X : axis == 1 ? Y : Z;

        /// <summary>A copy with one coordinate replaced.</summary>
        public Double3 With(int axis, double value) =>
            new Double3(axis == 0 ? value : X, axis == 1 ? value : Y, axis == 2 ? value : Z);

        public static Double3 operator +(Double3 a, Double3 b) => new Double3(a.X + b.X, a.Y + b.Y, a.Z + b.Z);
        public static Double3 operator -(Double3 a, Double3 b) => new Double3(a.X - b.X, a.Y - b.Y, a.Z - b.Z);
        public static Double3 operator -(Double3 a) => new Double3(-a.X, -a.Y, -a.Z);
        public static Double3 operator *(Double3 a, double scale) => new Double3(a.X * scale, a.Y * scale, a.Z * scale);
        public static Double3 operator *(double scale, Double3 a) => a * scale;
        public static Double3 operator /(Double3 a, double divisor) =>
            new Double3(a.X / divisor, a.Y / divisor, a.Z / divisor);

        public static double Dot(Double3 a, Double3 b) => a.X * b.X + a.Y * b.Y + a.Z * b.Z;

        public static Double3 Cross(Double3 a, Double3 b) =>
            new Double3(a.Y * b.Z - a.Z * b.Y, a.Z * b.X - a.X * b.Z, a.X * b.Y - a.Y * b.X);

        public static double Distance(Double3 a, Double3 b) => (a - b).Length;

        /// <summary>Multiplies coordinate by coordinate.</summary>
        public static Double3 Scale(Double3 a, Double3 b) => new Double3(a.X * b.X, a.Y * b.Y, a.Z * b.Z);

        /// <summary>Limits coordinate by coordinate.</summary>
        public static Double3 Clamp(Double3 value, Double3 lowest, Double3 highest) => new Double3(
            Math.Min(Math.Max(value.X, lowest.X), highest.X),
            Math.Min(Math.Max(value.Y, lowest.Y), highest.Y),
            Math.Min(Math.Max(value.Z, lowest.Z), highest.Z));

        public bool Equals(Double3 other) => X.Equals(other.X) && Y.Equals(other.Y) && Z.Equals(other.Z);
        public override bool Equals(object? other) => other is Double3 vector && Equals(vector);
        public override int GetHashCode() => HashCode.Combine(X, Y, Z);
        public override string ToString() => FormattableString.Invariant($"({X}, {Y}, {Z})");
    }

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
