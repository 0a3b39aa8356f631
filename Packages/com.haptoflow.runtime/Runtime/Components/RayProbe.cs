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
    /// next, better direction. The first directions are the last contact's normal, the direction from which the tip
    /// came, and the six axes. A short ray goes first, so that the far side of a thin wall is not taken for the
    /// surface.</para>
    /// <para>No ray is cast for a tip out of reach of the collider's bounds. A tip that was touching, or that crossed
    /// the surface since the last frame, may be outside flat bounds and is still tested.</para>
    /// <para>Limits: a tip deeper than <see cref="MaximumDepthMetres"/> behind a face counts as outside; in a corner the
    /// face that was touched first stays; an object without rigid body that a script moves is hit at its pose of the
    /// last physics step, unless physics transforms are synchronised.</para>
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

        /// <param name="hit">The ray hit that found the point.</param>
        public static bool TryClosest(Collider collider, in RigidPose pose, in ProbeQuestion question,
            out SurfacePoint found, out RaycastHit hit)
        {
            hit = default;
            RigidPose physics = PhysicsPose(collider, pose);
            Double3 tip = physics.PointToWorld(pose.PointToLocal(question.TipMetres));
            Double3 cameFrom = question.PreviousTipMetres - question.TipMetres;
            if (IsOutOfBounds(collider, tip, question, cameFrom.Length))
            {
                found = default;
                return false;
            }
            var search = new Search(collider, question.ReachMetres, tip);
            if (question.PreviousLocalNormal.HasValue)
            {
                search.Try(physics.DirectionToWorld(question.PreviousLocalNormal.Value));
            }
            if (!search.Found && cameFrom.Length > MinimumMoveMetres)
            {
                search.Try(physics.DirectionToWorld(pose.DirectionToLocal(cameFrom / cameFrom.Length)));
            }
            if (!search.Found)
            {
                for (int axis = 0; axis < 3; ++axis)
                {
                    search.Try(physics.DirectionToWorld(Double3.Zero.With(axis, 1.0)));
                    search.Try(physics.DirectionToWorld(Double3.Zero.With(axis, -1.0)));
                }
            }
            found = search.Found
                ? new SurfacePoint(
                    physics.PointToLocal(search.Point), physics.DirectionToLocal(search.Normal), search.Distance)
                : default;
            hit = search.Hit;
            return search.Found && search.Distance <= question.ReachMetres;
        }

        private static bool IsOutOfBounds(Collider collider, Double3 tip, in ProbeQuestion question, double movedMetres)
        {
            double behind = question.PreviousLocalNormal.HasValue
                ? MaximumDepthMetres
                : Math.Min(movedMetres, MaximumDepthMetres);
            double margin = question.ReachMetres + behind + BoundsSlackMetres;
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
            {
                this.collider = collider;
                this.reach = reach;
                this.tip = tip;
                Found = false;
                Point = Double3.Zero;
                Normal = Double3.Up;
                Distance = double.PositiveInfinity;
                Hit = default;
            }

            public bool Found { get; private set; }
            public Double3 Point { get; private set; }
            public Double3 Normal { get; private set; }

            /// <summary>Signed distance in metres, negative inside.</summary>
            public double Distance { get; private set; }

            /// <summary>The ray hit that found the point.</summary>
            public RaycastHit Hit { get; private set; }

            public void Try(Double3 outward)
            {
                Try(outward, ShortLiftMetres + reach);
                if (!Found)
                {
                    Try(outward, MaximumDepthMetres + reach);
                }
            }

            private void Try(Double3 outward, double lift)
            {
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
                if (distance < -MaximumDepthMetres || distance > reach || Math.Abs(distance) >= Math.Abs(Distance))
                {
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
