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
}
