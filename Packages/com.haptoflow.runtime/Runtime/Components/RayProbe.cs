#nullable enable
using System;
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Searches the closest point of a mesh or a terrain, for which there is no formula, with rays from
    /// outside against front faces.</summary>
    /// <remarks>
    /// <para>A ray starts above the tip, away from the surface, and runs back through it; the normal of a hit gives the
    /// next, better direction. The first direction is the normal of the face that holds the tip: the last contact's, or
    /// that of the face which the tip's way since the last frame goes through. Then come the six axes. A short ray goes
    /// first, so that the far side of a thin wall is not taken for the surface.</para>
    /// <para>No ray is cast for a tip out of reach of the collider's bounds. A tip that was touching, or that crossed
    /// the surface since the last frame, may be outside flat bounds and is still tested.</para>
    /// <para>Limits: a tip deeper than <see cref="MaximumDepthMetres"/> behind a face counts as outside, unless the
    /// touch began there and rays find the mesh's far side or the tip is in another surface; an object without rigid
    /// body that a script moves is hit at its pose of the last physics step, unless physics transforms are
    /// synchronised.</para>
    /// </remarks>
    internal static class RayProbe
    {
        public const double MaximumDepthMetres = 0.02;
        private const double ShortLiftMetres = 0.004;
        private const double MinimumMoveMetres = 1e-5;

        // Ray hits have single precision.
        private const double MinimumOffsetMetres = 1e-5;
        private const double BoundsSlackMetres = 1e-4;
        private const int Refinements = 2;

        // A mesh that is wider counts as endless.
        private const double MaximumWidthMetres = 10.0;

        public static bool TryClosest(Collider collider, in RigidPose pose, in ProbeQuestion question,
            in HeldFace held, ref ProbeAnswer answer)
        {
            RigidPose physics = PhysicsPose(collider, pose);
            Double3 tip = physics.PointToWorld(pose.PointToLocal(question.TipMetres));
            double behind = held.Normal.HasValue ? HeldFace.MaximumDepthMetres : 0.0;
            if (IsOutOfBounds(collider, tip, question.ReachMetres + behind))
            {
                return false;
            }
            var search = new Search(collider, question.ReachMetres, tip);
            if (held.Normal.HasValue)
            {
                search.TryHeld(physics.DirectionToWorld(held.Normal.Value), held);
            }
            if (!search.Found)
            {
                for (int axis = 0; axis < 3; ++axis)
                {
                    search.Try(physics.DirectionToWorld(Double3.Zero.With(axis, 1.0)));
                    search.Try(physics.DirectionToWorld(Double3.Zero.With(axis, -1.0)));
                }
            }
            if (!search.Found || search.Distance > question.ReachMetres)
            {
                return false;
            }
            answer.Point = new SurfacePoint(physics.PointToLocal(search.Point),
                physics.DirectionToLocal(search.Normal), search.Distance, search.Beyond);
            answer.Hit = search.Hit;
            return true;
        }

        /// <summary>Where the tip's way first goes through a front face.</summary>
        public static SurfaceEntry? EntryInto(
            Collider collider, in RigidPose pose, Double3 from, Double3 tip, out RaycastHit? hit)
        {
            hit = null;
            Double3 path = tip - from;
            double length = path.Length;
            if (length <= MinimumMoveMetres)
            {
                return null;
            }
            RigidPose physics = PhysicsPose(collider, pose);
            if (IsOutOfBounds(collider, physics.PointToWorld(tip), length))
            {
                return null;
            }
            var ray = new Ray(physics.PointToWorld(from).ToVector(),
                (physics.DirectionToWorld(path) / length).ToVector());
            if (!collider.Raycast(ray, out RaycastHit place, (float)length))
            {
                return null;
            }
            hit = place;
            Double3 normal = physics.DirectionToLocal(Vectors.UnitOr(place.normal.ToDouble(), Double3.Up));
            return new SurfaceEntry(physics.PointToLocal(place.point.ToDouble()), normal, place.distance / length);
        }

        /// <summary>True for a tip that went through a mesh and is straight below the face that holds it.</summary>
        public static bool IsThrough(
            Collider collider, in RigidPose pose, in ProbeQuestion question, in HeldFace held)
        {
            RigidPose physics = PhysicsPose(collider, pose);
            Double3 tip = physics.PointToWorld(pose.PointToLocal(question.TipMetres));
            var search = new Search(collider, question.ReachMetres, tip);
            search.TryHeld(physics.DirectionToWorld(held.Normal!.Value), held);
            return search.Found && search.Beyond > 0.0;
        }

        private static bool IsOutOfBounds(Collider collider, Double3 tip, double withinMetres)
        {
            double margin = withinMetres + BoundsSlackMetres;
            return collider.bounds.SqrDistance(tip.ToVector()) > margin * margin;
        }

        /// <summary>Pose in the physics engine of a collider that is drawn at another pose.</summary>
        private static RigidPose PhysicsPose(Collider collider, in RigidPose pose)
        {
            Rigidbody body = collider.attachedRigidbody!;
            if (body == null)
            {
                return pose;
            }
            RigidPose drawn = Conversions.PoseOf(body.transform);
            RigidPose simulated = Conversions.PoseOf(body.position, body.rotation);
            return new RigidPose(
                simulated.PointToWorld(drawn.PointToLocal(pose.PositionMetres)),
                simulated.Rotation * drawn.Rotation.Inverse * pose.Rotation);
        }

        private struct Search
        {
            private readonly Collider collider;
            private readonly double reach;
            private readonly Double3 tip;

            public Search(Collider collider, double reach, Double3 tip)
                : this()
            {
                (this.collider, this.reach, this.tip) = (collider, reach, tip);
                Normal = Double3.Up;
                Distance = double.PositiveInfinity;
            }

            public bool Found { get; private set; }
            public Double3 Point { get; private set; }
            public Double3 Normal { get; private set; }

            public double Distance { get; private set; }

            /// <summary>Distance from the mesh's far side for a tip that went through it, 0 for one that did
            /// not.</summary>
            public double Beyond { get; private set; }

            public RaycastHit Hit { get; private set; }

            public void Try(Double3 outward)
            {
                Try(outward, ShortLiftMetres, false);
                if (!Found)
                {
                    Try(outward, MaximumDepthMetres, false);
                }
            }

            /// <summary>Searches the face that holds the tip, and decides whether it still does.</summary>
            public void TryHeld(Double3 outward, in HeldFace held)
            {
                if (!held.CameFromOutside)
                {
                    Try(outward);
                }
                else if (!TryThrough(outward, ShortLiftMetres) && !TryThrough(outward, MaximumDepthMetres))
                {
                    TryThrough(outward, HeldFace.MaximumDepthMetres);
                }
                if (!Found || Distance >= 0.0)
                {
                    return;
                }
                if (held.CameFromOutside)
                {
                    FindFarSide();
                }
                if (Beyond <= 0.0 && -Distance > held.MarginMetres)
                {
                    TryBeside(held);
                }
            }

            private bool TryThrough(Double3 outward, double lift)
            {
                Try(outward, lift, true);
                return Found;
            }

            /// <summary>A front face between the held face and the tip is that of the far side: the tip went through.
            /// A tip deep behind a face without any far side is behind an open mesh.</summary>
            private void FindFarSide()
            {
                double depth = -Distance;
                if (CastTo(tip, Normal, depth, out RaycastHit hit))
                {
                    Beyond = Math.Max(hit.distance, MinimumOffsetMetres);
                }
                else if (depth > MaximumDepthMetres &&
                    double.IsInfinity(FarSideMetres(Normal, HeldFace.MaximumDepthMetres)))
                {
                    Beyond = depth;
                }
            }

            /// <summary>Takes the nearest face beside the held one if it is nearer than that, unless the mesh is
            /// thinner below the held one.</summary>
            private void TryBeside(in HeldFace held)
            {
                double depth = -Distance;
                Double3 first = Vectors.UnitOr(
                    Double3.Cross(Normal, Math.Abs(Normal.X) < 0.9 ? Double3.Right : Double3.Up), Double3.Right);
                Double3 second = Double3.Cross(Normal, first);
                double nearest = depth - held.MarginMetres;
                Double3 outward = Double3.Zero;
                RaycastHit found = default;
                for (int index = 0; index < 4; ++index)
                {
                    Double3 side = (index < 2 ? first : second) * (index % 2 == 0 ? 1.0 : -1.0);
                    bool isHit = CastTo(tip + side * depth, -side, depth, out RaycastHit hit) &&
                        Double3.Dot(hit.normal.ToDouble(), side) > HeldFace.SameSideCosine;
                    if (isHit && depth - hit.distance < nearest)
                    {
                        nearest = depth - hit.distance;
                        outward = side;
                        found = hit;
                    }
                }
                if (outward.Equals(Double3.Zero) || (held.Holds(depth) && IsThinner(depth, outward, nearest)))
                {
                    return;
                }
                Normal = Vectors.UnitOr(found.normal.ToDouble(), outward);
                Distance = -nearest;
                Point = tip + Normal * nearest;
                Hit = found;
            }

            /// <summary>True where the mesh is thinner below the held face than it is wide below the one
            /// beside.</summary>
            private bool IsThinner(double depth, Double3 outward, double besideMetres)
            {
                double thickness = depth + FarSideMetres(Normal, HeldFace.MaximumDepthMetres);
                double rest = Math.Min(thickness, MaximumWidthMetres) - besideMetres;
                return !double.IsInfinity(thickness) && double.IsInfinity(FarSideMetres(outward, rest));
            }

            /// <summary>Distance of the far side opposite a normal; infinite beyond the limit.</summary>
            private double FarSideMetres(Double3 normal, double limitMetres) =>
                CastTo(tip - normal * limitMetres, normal, limitMetres, out RaycastHit hit)
                    ? limitMetres - hit.distance
                    : double.PositiveInfinity;

            private bool CastTo(Double3 from, Double3 direction, double metres, out RaycastHit hit) =>
                collider.Raycast(new Ray(from.ToVector(), direction.ToVector()), out hit, (float)metres);

            /// <param name="isHeld">True for a face that the tip may have gone through to the far side and
            /// beyond.</param>
            private void Try(Double3 outward, double liftMetres, bool isHeld)
            {
                double lift = liftMetres + reach;
                double maximumDepth = isHeld ? HeldFace.MaximumDepthMetres : MaximumDepthMetres;
                if (!Cast(outward, lift, out Double3 point, out Double3 normal, out RaycastHit hit))
                {
                    return;
                }
                for (int round = 0; round < Refinements; ++round)
                {
                    if (!Cast(normal, lift, out Double3 nearer, out Double3 better, out RaycastHit nearerHit))
                    {
                        break;
                    }
                    hit = nearerHit;
                    point = nearer;
                    normal = better;
                }
                Double3 offset = tip - point;
                double along = Double3.Dot(offset, normal);
                // Beside an edge no face lies below the tip: the normal points from the edge to the tip.
                bool beside = along >= 0.0 && offset.Length > along + MinimumOffsetMetres;
                double distance = beside ? offset.Length : along;
                if (distance < -maximumDepth || distance > reach || Math.Abs(distance) >= Math.Abs(Distance))
                {
                    return;
                }
                if (!isHeld && distance < 0.0 && CastTo(tip, normal, -distance, out _))
                {
                    // Another front face lies between: the tip is in front of that one, not behind this one.
                    return;
                }
                Found = true;
                Hit = hit;
                Distance = distance;
                Point = beside ? point : tip - normal * along;
                Normal = beside ? offset / offset.Length : normal;
            }

            private bool Cast(
                Double3 outward, double lift, out Double3 point, out Double3 normal, out RaycastHit place)
            {
                var ray = new Ray((tip + outward * lift).ToVector(), (-outward).ToVector());
                bool hit = collider.Raycast(ray, out place, (float)(lift + reach));
                point = hit ? place.point.ToDouble() : Double3.Zero;
                normal = hit ? Vectors.UnitOr(place.normal.ToDouble(), Double3.Up) : Double3.Up;
                return hit;
            }
        }
    }
}
