#nullable enable
using System;

namespace HaptoFlow.Numerics
{
    /// <summary>A position or direction in Unity's left-handed frame with y up. Its numbers are doubles, so that a hand's
    /// motion stays precise far from the origin.</summary>
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

        public double this[int axis] => axis == 0 ? X : axis == 1 ? Y : Z;

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

        public static Double3 Scale(Double3 a, Double3 b) => new Double3(a.X * b.X, a.Y * b.Y, a.Z * b.Z);

        public static Double3 Clamp(Double3 value, Double3 lowest, Double3 highest) => new Double3(
            Math.Min(Math.Max(value.X, lowest.X), highest.X),
            Math.Min(Math.Max(value.Y, lowest.Y), highest.Y),
            Math.Min(Math.Max(value.Z, lowest.Z), highest.Z));

        public bool Equals(Double3 other) => X.Equals(other.X) && Y.Equals(other.Y) && Z.Equals(other.Z);
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
        public override string ToString() => FormattableString.Invariant($"({X}, {Y}, {Z}, {W})");
    }

    /// <summary>Three perpendicular unit vectors with third = first x second.</summary>
    internal readonly struct RotationBasis
    {
        /// <param name="third">A unit vector perpendicular to the first.</param>
        public RotationBasis(Double3 first, Double3 third) =>
            (First, Second, Third) = (first, Double3.Cross(third, first), third);

        public Double3 First { get; }

        public Double3 Second { get; }

        public Double3 Third { get; }

        public static Rotation Between(in RotationBasis from, in RotationBasis to)
        {
            // Columns of the matrix to * transposed(from), converted to a quaternion by Shepperd (1978).
            Double3 x = Column(from, to, 0);
            Double3 y = Column(from, to, 1);
            Double3 z = Column(from, to, 2);
            double trace = x.X + y.Y + z.Z;
            if (trace >= x.X && trace >= y.Y && trace >= z.Z)
            {
                return new Rotation(y.Z - z.Y, z.X - x.Z, x.Y - y.X, 1.0 + trace).Unit;
            }
            if (x.X >= y.Y && x.X >= z.Z)
            {
                return new Rotation(1.0 + x.X - y.Y - z.Z, x.Y + y.X, z.X + x.Z, y.Z - z.Y).Unit;
            }
            return y.Y >= z.Z
                ? new Rotation(x.Y + y.X, 1.0 + y.Y - x.X - z.Z, y.Z + z.Y, z.X - x.Z).Unit
                : new Rotation(z.X + x.Z, y.Z + z.Y, 1.0 + z.Z - x.X - y.Y, x.Y - y.X).Unit;
        }

        /// <summary>The image of one coordinate axis under the rotation.</summary>
        private static Double3 Column(in RotationBasis from, in RotationBasis to, int axis) =>
            to.First * from.First[axis] + to.Second * from.Second[axis] + to.Third * from.Third[axis];
    }

    /// <summary>The pose of an object without scale: position in metres and unit rotation.</summary>
    internal readonly struct RigidPose : IEquatable<RigidPose>
    {
        public readonly Double3 PositionMetres;
        public readonly Rotation Rotation;

        /// <summary>Values that are not usable become the origin or the identity.</summary>
        public RigidPose(Double3 positionMetres, Rotation rotation)
        {
            PositionMetres = Vectors.IsUsable(positionMetres) ? positionMetres : Double3.Zero;
            Rotation = rotation.Unit;
        }

        public static RigidPose Identity => new RigidPose(Double3.Zero, Rotation.Identity);

        public Double3 PointToWorld(Double3 local) => PositionMetres + Rotation * local;
        public Double3 PointToLocal(Double3 world) => Rotation.Inverse * (world - PositionMetres);
        public Double3 DirectionToWorld(Double3 local) => Rotation * local;
        public Double3 DirectionToLocal(Double3 world) => Rotation.Inverse * world;

        /// <summary>Interpolates from <paramref name="a"/> (share 0) to <paramref name="b"/> (share 1); other shares
        /// extrapolate.</summary>
        public static RigidPose Between(in RigidPose a, in RigidPose b, double share) => new RigidPose(
            a.PositionMetres + share * (b.PositionMetres - a.PositionMetres),
            Rotation.Slerp(a.Rotation, b.Rotation, share));

        public bool Equals(RigidPose other) =>
            PositionMetres.Equals(other.PositionMetres) && Rotation.Equals(other.Rotation);
        public override string ToString() => FormattableString.Invariant($"{PositionMetres} {Rotation}");
    }
}
