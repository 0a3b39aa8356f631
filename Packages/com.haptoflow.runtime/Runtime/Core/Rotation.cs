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

    /// <summary>Three perpendicular unit vectors with third = first x second.</summary>
    internal readonly struct RotationBasis
    {
        /// <param name="first">A unit vector.</param>
        /// <param name="third">A unit vector perpendicular to the first.</param>
        public RotationBasis(Double3 first, Double3 third) =>
            (First, Second, Third) = (first, Double3.Cross(third, first), third);

        public Double3 First { get; }

        public Double3 Second { get; }

        public Double3 Third { get; }

        /// <summary>The rotation that maps one basis to the other.</summary>
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
        public override bool Equals(object? other) => other is RigidPose pose && Equals(pose);
        public override int GetHashCode() => HashCode.Combine(PositionMetres, Rotation);
        public override string ToString() => FormattableString.Invariant($"{PositionMetres} {Rotation}");
    }
}
