#nullable enable
using System;
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>State of the tip that a search for the closest point needs.</summary>
    internal readonly struct ProbeQuestion
    {
        public readonly Double3 TipMetres;

        public readonly double ReachMetres;

        /// <summary>The face of the collider that holds the tip.</summary>
        public readonly HeldFace Held;

        /// <summary>Position of the tip in the last frame, in the collider's local frame; null where the tip's way into
        /// the collider does not matter.</summary>
        public readonly Double3? PathStart;

        public ProbeQuestion(Double3 tipMetres, double reachMetres, in HeldFace held, Double3? pathStart = null) =>
            (TipMetres, ReachMetres, Held, PathStart) = (tipMetres, reachMetres, held, pathStart);
    }

    /// <summary>The answer of a search for the closest point.</summary>
    internal struct ProbeAnswer
    {
        public SurfacePoint Point;

        /// <summary>The part of the tip's last way before it entered the collider; more than 1 if it did not.</summary>
        public double EntryShare;

        /// <summary>The ray hit that found the point; null where no ray was needed.</summary>
        public RaycastHit? Hit;
    }

    /// <summary>Finds the point of a collider that is closest to the tip, at the pose where the collider is drawn; the
    /// physics engine may still hold the pose of the last physics step. Main thread, no garbage.</summary>
    internal static class ColliderProbe
    {
        public static bool IsSupportedKind(Collider collider) =>
            collider is BoxCollider || collider is SphereCollider || collider is CapsuleCollider ||
            collider is CharacterController || collider is MeshCollider || collider is TerrainCollider;

        /// <summary>Pose of the collider's local frame. Character controllers and terrains stay upright whatever the
        /// rotation of their transform.</summary>
        public static RigidPose PoseOf(Collider collider) =>
            collider is CharacterController || collider is TerrainCollider
            ? Conversions.PoseOf(collider.transform.position, Quaternion.identity)
            : Conversions.PoseOf(collider.transform);

        /// <summary>No point of the collider, where it is drawn, is nearer to a point than this, in metres.</summary>
        public static double DistanceBoundMetres(Collider collider, Double3 pointMetres)
        {
            Double3 scale = collider.transform.lossyScale.ToDouble();
            Double3 point = PoseOf(collider).PointToLocal(pointMetres);
            if (IsRound(collider, scale, out RoundShape round))
            {
                return Math.Max(0.0, round.Closest(point, default).SignedDistanceMetres);
            }
            if (!TryGetBounds(collider, out Bounds bounds))
            {
                return 0.0;
            }
            Double3 half = 0.5 * Double3.Scale(bounds.size.ToDouble(), scale).Absolute;
            Double3 outside = (point - Double3.Scale(bounds.center.ToDouble(), scale)).Absolute - half;
            return new Double3(
                Math.Max(0.0, outside.X), Math.Max(0.0, outside.Y), Math.Max(0.0, outside.Z)).Length;
        }

        /// <summary>A box around the collider in its local frame, before its scale; false where there is none.</summary>
        internal static bool TryGetBounds(Collider collider, out Bounds bounds)
        {
            bounds = collider switch
            {
                BoxCollider box => new Bounds(box.center, box.size),
                MeshCollider mesh when mesh.sharedMesh != null => mesh.sharedMesh.bounds,
                TerrainCollider terrain when terrain.terrainData != null =>
                    new Bounds(0.5f * terrain.terrainData.size, terrain.terrainData.size),
                _ => default,
            };
            return bounds.size != Vector3.zero;
        }

        /// <summary>False where no point is within reach, or the kind of collider is not supported.</summary>
        public static bool TryClosest(
            Collider collider, in RigidPose pose, in ProbeQuestion question, out ProbeAnswer answer)
        {
            answer = new ProbeAnswer { EntryShare = 2.0 };
            Double3 tip = pose.PointToLocal(question.TipMetres);
            Double3 scale = collider.transform.lossyScale.ToDouble();
            RaycastHit? entryHit = null;
            SurfaceEntry? entry = question.PathStart.HasValue
                ? EntryInto(collider, pose, scale, question.PathStart.Value, tip, out entryHit)
                : null;
            HeldFace held = entry.HasValue ? question.Held.EnteredBy(entry.Value) : question.Held;
            bool isNear = TryClosest(collider, pose, scale, tip, held, question, ref answer);
            if (!entry.HasValue)
            {
                return isNear;
            }
            answer.EntryShare = entry.Value.Share;
            bool isIn = isNear && answer.Point.BeyondMetres <= 0.0 && answer.Point.SignedDistanceMetres <= 0.0;
            if (!isIn && !held.IsTouched)
            {
                // The tip came out again within the frame: it touched where it went in.
                answer.Point = entry.Value.PassedBy(tip);
                answer.Hit = entryHit;
                return true;
            }
            return isNear;
        }

        private static bool TryClosest(Collider collider, in RigidPose pose, Double3 scale, Double3 tip,
            in HeldFace held, in ProbeQuestion question, ref ProbeAnswer answer)
        {
            switch (collider)
            {
                case BoxCollider box:
                    Double3 centre = Centre(box.center, scale);
                    answer.Point = Moved(Shapes.OnBox(SizeOf(box, scale), tip - centre, held), centre);
                    break;
                case MeshCollider mesh when mesh.convex &&
                    ConvexProbe.TryOutside(mesh, pose, question, held, ref answer):
                    break;
                case MeshCollider _:
                case TerrainCollider _:
                    return RayProbe.TryClosest(collider, pose, question, held, ref answer);
                default:
                    if (!IsRound(collider, scale, out RoundShape round))
                    {
                        return false;
                    }
                    answer.Point = round.Closest(tip, held);
                    break;
            }
            return answer.Point.SignedDistanceMetres <= question.ReachMetres;
        }

        private static SurfaceEntry? EntryInto(Collider collider, in RigidPose pose, Double3 scale, Double3 from,
            Double3 tip, out RaycastHit? hit)
        {
            hit = null;
            switch (collider)
            {
                case BoxCollider box:
                    Double3 centre = Centre(box.center, scale);
                    return Shapes.EntryOfBox(SizeOf(box, scale), from - centre, tip - centre)?.MovedBy(centre);
                case MeshCollider _:
                case TerrainCollider _:
                    return RayProbe.EntryInto(collider, pose, from, tip, out hit);
                default:
                    return IsRound(collider, scale, out RoundShape round) ? round.EntryOf(from, tip) : null;
            }
        }

        private static Double3 SizeOf(BoxCollider box, Double3 scale) =>
            Double3.Scale(box.size.ToDouble(), scale).Absolute;

        private static bool IsRound(Collider collider, Double3 scale, out RoundShape round)
        {
            Double3 size = scale.Absolute;
            switch (collider)
            {
                case SphereCollider sphere:
                    round = new RoundShape(Centre(sphere.center, scale), sphere.radius * size.Largest, 0.0, 1);
                    return true;
                case CapsuleCollider capsule:
                    int axis = capsule.direction;
                    round = new RoundShape(Centre(capsule.center, scale),
                        capsule.radius * size.With(axis, 0.0).Largest, capsule.height * size[axis], axis);
                    return true;
                case CharacterController controller:
                    round = new RoundShape(Centre(controller.center, scale),
                        controller.radius * Math.Max(size.X, size.Z), controller.height * size.Y, 1);
                    return true;
                default:
                    round = default;
                    return false;
            }
        }

        private static Double3 Centre(Vector3 centre, Double3 scale) => Double3.Scale(centre.ToDouble(), scale);

        private static SurfacePoint Moved(in SurfacePoint point, Double3 by) =>
            new SurfacePoint(
                point.PointMetres + by, point.Normal, point.SignedDistanceMetres, point.BeyondMetres);

        private readonly struct RoundShape
        {
            private readonly Double3 centre;
            private readonly double radius;
            private readonly double height;
            private readonly int axis;

            public RoundShape(Double3 centre, double radius, double height, int axis) =>
                (this.centre, this.radius, this.height, this.axis) = (centre, radius, height, axis);

            public SurfacePoint Closest(Double3 tip, in HeldFace held)
            {
                Double3? normal = held.Normal.HasValue ? Swapped(held.Normal.Value) : (Double3?)null;
                var swapped = new HeldFace(normal, held.CameFromOutside, held.MarginMetres, held.IsTouched);
                SurfacePoint upright = Shapes.OnCapsule(radius, height, Swapped(tip - centre), swapped);
                return new SurfacePoint(Swapped(upright.PointMetres) + centre, Swapped(upright.Normal),
                    upright.SignedDistanceMetres, upright.BeyondMetres);
            }

            public SurfaceEntry? EntryOf(Double3 from, Double3 to)
            {
                SurfaceEntry? upright =
                    Shapes.EntryOfCapsule(radius, height, Swapped(from - centre), Swapped(to - centre));
                return upright.HasValue
                    ? new SurfaceEntry(Swapped(upright.Value.PointMetres) + centre, Swapped(upright.Value.Normal),
                        upright.Value.Share)
                    : (SurfaceEntry?)null;
            }

            /// <summary>Shapes expects the axis along y: swaps that coordinate, before and after.</summary>
            private Double3 Swapped(Double3 vector) => axis == 0
                ? new Double3(vector.Y, vector.X, vector.Z)
                : axis == 2 ? new Double3(vector.X, vector.Z, vector.Y) : vector;
        }
    }

    /// <summary>The closest point of a convex mesh to a tip outside of it, at the pose where the mesh is drawn. The
    /// physics engine computes it exactly.</summary>
    internal static class ConvexProbe
    {
        // At smaller distances rounding dominates the direction to the closest point; rays then give the face's own
        // normal.
        private const double MinimumDistanceMetres = 1e-4;

        /// <summary>False for a tip inside the mesh or on its surface, and for one that went through it and is held by
        /// the face that it entered.</summary>
        public static bool TryOutside(MeshCollider mesh, in RigidPose pose, in ProbeQuestion question,
            in HeldFace held, ref ProbeAnswer answer)
        {
            mesh.transform.GetPositionAndRotation(out Vector3 position, out Quaternion rotation);
            Vector3 nearest = Physics.ClosestPoint(question.TipMetres.ToVector(), mesh, position, rotation);
            Double3 tip = pose.PointToLocal(question.TipMetres);
            Double3 point = pose.PointToLocal(nearest.ToDouble());
            double distance = Double3.Distance(tip, point);
            Double3 normal = Vectors.UnitOr(tip - point, Double3.Up);
            answer.Point = new SurfacePoint(point, normal, distance);
            bool isAway = held.Holds(0.0) &&
                Double3.Dot(normal, held.Normal!.Value) < -HeldFace.SameSideCosine;
            return distance > MinimumDistanceMetres &&
                !(isAway && RayProbe.IsThrough(mesh, pose, question, held));
        }
    }

    /// <summary>Makes rays hit only the front faces of meshes while it exists. With Physics.queriesHitBackfaces a hit
    /// on a back face has an inverted normal and would count as a front. Dispose restores the project's setting. Main
    /// thread, no garbage.</summary>
    internal readonly struct FrontFacesOnly : IDisposable
    {
        private readonly bool hitBackFaces;

        private FrontFacesOnly(bool hitBackFaces) => this.hitBackFaces = hitBackFaces;

        public static FrontFacesOnly Begin()
        {
            bool before = Physics.queriesHitBackfaces;
            if (before)
            {
                Physics.queriesHitBackfaces = false;
            }
            return new FrontFacesOnly(before);
        }

        public void Dispose()
        {
            if (hitBackFaces)
            {
                Physics.queriesHitBackfaces = true;
            }
        }
    }
}
