#nullable enable
using System;

namespace HaptoFlow.Numerics
{
    /// <summary>A rotation as a quaternion in double precision, in Unity's order x, y, z, w.</summary>
    internal readonly struct Rotation : IEquatable<Rotation>
    {
        public readonly double X;
        public readonly double Y;
        public readonly double Z;
        public readonly double W;

        public Rotation(double x, double y, double z, double w) => (X, Y, Z, W) = (x, y, z, w);

        public static Rotation Identity => new Rotation(0.0, 0.0, 0.0, 1.0);

        public Rotation Inverse => new Rotation(-X, -Y, -Z, W);

        /// <summary>Rotates a vector. The rotation must have length 1.</summary>
        public static Double3 operator *(Rotation rotation, Double3 vector)
        {
            var axis = new Double3(rotation.X, rotation.Y, rotation.Z);
            Double3 once = Double3.Cross(axis, vector);
            return vector + 2.0 * (rotation.W * once + Double3.Cross(axis, once));
        }

        /// <summary>Applies <paramref name="b"/> first, then <paramref name="a"/>.</summary>
        public static Rotation operator *(Rotation a, Rotation b) => new Rotation(
            a.W * b.X + a.X * b.W + a.Y * b.Z - a.Z * b.Y,
            a.W * b.Y + a.Y * b.W + a.Z * b.X - a.X * b.Z,
            a.W * b.Z + a.Z * b.W + a.X * b.Y - a.Y * b.X,
            a.W * b.W - a.X * b.X - a.Y * b.Y - a.Z * b.Z);

        /// <summary>The rotation at length 1; the identity where it is zero or not finite.</summary>
        public Rotation Unit
        {
            get
            {
                double largest = Math.Max(Math.Max(Math.Abs(X), Math.Abs(Y)), Math.Max(Math.Abs(Z), Math.Abs(W)));
                if (!Vectors.IsFinite(X + Y + Z + W) || !(largest > 1e-300))
                {
                    return Identity;
                }
                double x = X / largest;
                double y = Y / largest;
                double z = Z / largest;
                double w = W / largest;
                double length = Math.Sqrt(x * x + y * y + z * z + w * w);
                return new Rotation(x / length, y / length, z / length, w / length);
            }
        }

        /// <summary>Interpolates from <paramref name="a"/> (share 0) to <paramref name="b"/> (share 1) along the
        /// shorter way at a constant rate; other shares extrapolate.</summary>
        public static Rotation Slerp(Rotation a, Rotation b, double share)
        {
            double cosine = a.X * b.X + a.Y * b.Y + a.Z * b.Z + a.W * b.W;
            double sign = cosine < 0.0 ? -1.0 : 1.0;
            cosine *= sign;
            double toA = 1.0 - share;
            double toB = share;
            if (cosine < 1.0 - 1e-12)
            {
                double angle = Math.Acos(cosine);
                double sine = Math.Sin(angle);
                toA = Math.Sin((1.0 - share) * angle) / sine;
                toB = Math.Sin(share * angle) / sine;
            }
            toB *= sign;
            var between = new Rotation(
                toA * a.X + toB * b.X, toA * a.Y + toB * b.Y, toA * a.Z + toB * b.Z, toA * a.W + toB * b.W);
            return between.Unit;
        }

        public bool Equals(Rotation other) =>
            X.Equals(other.X) && Y.Equals(other.Y) && Z.Equals(other.Z) && W.Equals(other.W);
        public override bool Equals(object? other) => other is Rotation rotation && Equals(rotation);
        public override int GetHashCode() => HashCode.Combine(X, Y, Z, W);
        public override string ToString() => FormattableString.Invariant($"({X}, {Y}, {Z}, {W})");
    }
}
