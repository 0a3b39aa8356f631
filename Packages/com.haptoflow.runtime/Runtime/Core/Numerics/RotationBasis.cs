#nullable enable

namespace HaptoFlow.Numerics
{
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
}
