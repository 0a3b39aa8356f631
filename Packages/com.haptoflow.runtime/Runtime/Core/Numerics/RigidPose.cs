#nullable enable
using System;

namespace HaptoFlow.Numerics
{
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
