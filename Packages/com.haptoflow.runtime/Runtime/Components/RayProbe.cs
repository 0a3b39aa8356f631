#nullable enable
using System;
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>The nearest place on a mesh or a terrain, which have no formula: by rays from outside against front
    /// faces.</summary>
    /// <remarks>
    /// <para>A ray starts above the tip, away from the surface, and runs back through it; a hit's normal gives the
    /// next,
    /// better direction. Directions to start with: the last contact's normal, the way the tip came, and six axes. A
    /// short ray goes first, so that a thin wall opposite is not taken for the surface.</para>
    /// <para>No ray is cast for a tip that the collider's bounds keep out of reach. A tip that was touching, or that
    /// came through the surface since the last frame, may be beyond flat bounds and is still asked for.</para>
    /// <para>Limits: a tip deeper than <see cref="DeepestMetres"/> behind a face counts as outside; in a corner the
    /// face
    /// that was touched first stays; an object without rigid body that a script moves is hit where it was at the last
    /// physics step, unless physics transforms are synchronised.</para>
    /// </remarks>
    internal static class RayProbe
    {
        public const double DeepestMetres = 0.02;
        private const double ShortLiftMetres = 0.004;
        private const double SmallestMoveMetres = 1e-5;

        // Hits come in single precision.
        private const double SmallestOffsetMetres = 1e-5;
        private const double BoundsSlackMetres = 1e-4;
        private const int Refinements = 2;

        /// <param name="hit">Of the ray that found the place.</param>
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
            if (!search.Found && cameFrom.Length > SmallestMoveMetres)
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
                ? DeepestMetres
                : Math.Min(movedMetres, DeepestMetres);
            double margin = question.ReachMetres + behind + BoundsSlackMetres;
            return collider.bounds.SqrDistance(tip.ToVector()) > margin * margin;
        }

        /// <summary>Where the physics engine has a collider that is drawn at a pose.</summary>
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

            /// <summary>Signed, negative inside.</summary>
            public double Distance { get; private set; }

            /// <summary>Of the ray that found the place.</summary>
            public RaycastHit Hit { get; private set; }

            public void Try(Double3 outward)
            {
                Try(outward, ShortLiftMetres + reach);
                if (!Found)
                {
                    Try(outward, DeepestMetres + reach);
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
                // Beside an edge no face lies straight below the tip: the way to the edge is the normal there.
                bool beside = along >= 0.0 && offset.Length > along + SmallestOffsetMetres;
                double distance = beside ? offset.Length : along;
                if (distance < -DeepestMetres || distance > reach || Math.Abs(distance) >= Math.Abs(Distance))
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
