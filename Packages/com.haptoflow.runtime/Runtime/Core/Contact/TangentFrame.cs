#nullable enable
using System;
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>The tangent axes of one touch: two unit vectors in the object's local frame with first x second =
    /// normal.</summary>
    /// <remarks>
    /// <para>Where the grain is more than 30 degrees from the normal, the first axis is the grain's projection onto the
    /// tangent plane. Closer to the normal the projection spins and then vanishes; there the axes are carried along the
    /// stroke without twist (parallel transport), with a smooth transition between 30 and 20 degrees. Where the grain
    /// applies again, the carried axes turn towards it no faster than the normal turns (times the projection's
    /// sensitivity) plus <see cref="TurnRadiansPerSecond"/>, so that no frame sees a jump.</para>
    /// <para>Within a touch the sign of the grain is ignored: after crossing its pole the axes keep the sign that they
    /// arrived with, since turning them by 180 degrees would pass through a state in which a stroke along the grain
    /// feels like one across it. Each touch starts with the grain's own sign.</para>
    /// </remarks>
    internal sealed class TangentFrame
    {
        public const double TurnRadiansPerSecond = 4.0;

        // Sines of the angle between grain and normal: below the first only carried axes, above the second only the
        // grain.
        private const double CarriedBelow = 0.342020143325669;
        private const double GrainAbove = 0.5;

        // A finite step across a curved surface turns the projection a little more than its derivative predicts.
        private const double FiniteStepAllowance = 1.2;

        private Double3 grain;
        private Double3 normal;
        private bool touching;

        /// <param name="grain">Direction in the object's local frame; local x where it has length 0.</param>
        public TangentFrame(Double3 grain) => Restart(grain);

        public Double3 First { get; private set; }

        public Double3 Second { get; private set; }

        public void Restart(Double3 newGrain)
        {
            grain = Vectors.UnitOr(newGrain, Double3.Right);
            normal = Double3.Up;
            First = Double3.Right;
            Second = new Double3(0.0, 0.0, -1.0);
            touching = false;
        }

        /// <summary>The next update starts a new touch.</summary>
        public void Reset() => touching = false;

        /// <summary>Computes the axes of the next frame of a stroke.</summary>
        /// <param name="surfaceNormal">Normal in the object's local frame; it is normalised. One of length 0 leaves the
        /// axes unchanged.</param>
        public void Update(Double3 surfaceNormal, double stepSeconds)
        {
            Double3 unit = Vectors.UnitOr(surfaceNormal, normal);
            First = touching ? CarriedFirstAxis(unit, stepSeconds) : FirstAxisOfNewTouch(unit);
            Second = Double3.Cross(unit, First);
            normal = unit;
            touching = true;
        }

        /// <summary>The first axis with which a touch begins where the normal is this one.</summary>
        public Double3 FirstAxisOfNewTouch(Double3 unit)
        {
            Double3 projected = IntoPlane(grain, unit);
            bool useful = projected.Length > CarriedBelow;
            Double3 reference = useful ? projected : IntoPlane(Vectors.AnyPerpendicular(grain), unit);
            return Vectors.UnitOr(reference, Vectors.AnyPerpendicular(unit));
        }

        private Double3 CarriedFirstAxis(Double3 unit, double stepSeconds)
        {
            Double3 carried = Vectors.UnitOr(
                IntoPlane(Carried(First, normal, unit), unit), Vectors.AnyPerpendicular(unit));
            Double3 projected = IntoPlane(grain, unit);
            double sine = projected.Length;
            double weight = GrainWeight(sine);
            if (weight <= 0.0)
            {
                return carried;
            }
            double angle = Math.Atan2(
                Double3.Dot(Double3.Cross(carried, projected), unit), Double3.Dot(carried, projected));
            if (angle > 0.5 * Math.PI)
            {
                angle -= Math.PI;
            }
            else if (angle < -0.5 * Math.PI)
            {
                angle += Math.PI;
            }
            double normalTurn = Math.Atan2(Double3.Cross(normal, unit).Length, Double3.Dot(normal, unit));
            double limit = weight *
                (TurnRadiansPerSecond * Math.Max(0.0, stepSeconds) + FiniteStepAllowance * normalTurn / sine);
            angle = Vectors.Clamp(angle, -limit, limit);
            return Vectors.UnitOr(
                Math.Cos(angle) * carried + Math.Sin(angle) * Double3.Cross(unit, carried), carried);
        }

        private static Double3 IntoPlane(Double3 vector, Double3 unit) => vector - unit * Double3.Dot(vector, unit);

        private static double GrainWeight(double sine)
        {
            double share = Vectors.Clamp((sine - CarriedBelow) / (GrainAbove - CarriedBelow), 0.0, 1.0);
            return share * share * (3.0 - 2.0 * share);
        }

        /// <summary>The axis after the smallest rotation that takes one unit vector to the other.</summary>
        private static Double3 Carried(Double3 axis, Double3 from, Double3 to)
        {
            double cosine = Double3.Dot(from, to);
            if (cosine < -1.0 + 1e-12)
            {
                return axis;
            }
            Double3 turn = Double3.Cross(from, to);
            Double3 once = Double3.Cross(turn, axis);
            return axis + once + Double3.Cross(turn, once) / (1.0 + cosine);
        }
    }
}
