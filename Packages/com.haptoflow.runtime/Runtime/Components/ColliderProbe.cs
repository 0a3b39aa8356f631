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

        /// <summary>Surfaces farther away are ignored.</summary>
        public readonly double ReachMetres;

        /// <summary>Normal of the last frame's contact with this collider, in the collider's local frame; null without
        /// one.</summary>
        public readonly Double3? PreviousLocalNormal;

        /// <summary>Position of the tip in the last frame.</summary>
        public readonly Double3 PreviousTipMetres;

        public readonly double FaceMarginMetres;

        public ProbeQuestion(Double3 tipMetres, double reachMetres, Double3? previousLocalNormal,
            Double3 previousTipMetres, double faceMarginMetres)
        {
            TipMetres = tipMetres;
            ReachMetres = reachMetres;
            PreviousLocalNormal = previousLocalNormal;
            PreviousTipMetres = previousTipMetres;
            FaceMarginMetres = faceMarginMetres;
        }
    }

    /// <summary>Finds the point of a collider that is closest to the tip, at the pose where the collider is drawn; the
    /// physics engine may still hold the pose of the last physics step. Main thread, no garbage.</summary>
    internal static class ColliderProbe
    {
        /// <summary>True for the kinds of collider that a tip can touch.</summary>
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
            LocalBounds(collider, out Vector3 middle, out Vector3 size);
            Double3 local = PoseOf(collider).PointToLocal(pointMetres) - Double3.Scale(middle.ToDouble(), scale);
            Double3 half = 0.5 * Double3.Scale(size.ToDouble(), scale).Absolute;
            Double3 outside = local.Absolute - half;
            return new Double3(
                Math.Max(0.0, outside.X), Math.Max(0.0, outside.Y), Math.Max(0.0, outside.Z)).Length;
        }

        /// <summary>A box around the collider in its local frame, before its scale.</summary>
        private static void LocalBounds(Collider collider, out Vector3 middle, out Vector3 size)
        {
            switch (collider)
            {
                case BoxCollider box:
                    (middle, size) = (box.center, box.size);
                    break;
                case SphereCollider sphere:
                    // The radius follows the largest scale.
                    (middle, size) = (sphere.center, Around(collider, 2f * sphere.radius));
                    break;
                case CapsuleCollider capsule:
                    (middle, size) = (capsule.center,
                        Around(collider, Mathf.Max(2f * capsule.radius, capsule.height)));
                    break;
                case CharacterController controller:
                    (middle, size) = (controller.center,
                        Around(collider, Mathf.Max(2f * controller.radius, controller.height)));
                    break;
                case MeshCollider mesh when mesh.sharedMesh != null:
                    Bounds bounds = mesh.sharedMesh.bounds;
                    (middle, size) = (bounds.center, bounds.size);
                    break;
                case TerrainCollider terrain when terrain.terrainData != null:
                    (middle, size) = (0.5f * terrain.terrainData.size, terrain.terrainData.size);
                    break;
                default:
                    (middle, size) = (Vector3.zero, new Vector3(1e6f, 1e6f, 1e6f));
                    break;
            }
        }

        /// <summary>A cube of a size that the largest scale of the collider gives all axes.</summary>
        private static Vector3 Around(Collider collider, float size)
        {
            Double3 scale = collider.transform.lossyScale.ToDouble().Absolute;
            double Axis(double own) => size * scale.Largest / Math.Max(own, 1e-9);
            return new Double3(Axis(scale.X), Axis(scale.Y), Axis(scale.Z)).ToVector();
        }

        /// <summary>False where no point is within reach, or the kind of collider is not supported.</summary>
        public static bool TryClosest(
            Collider collider, in RigidPose pose, in ProbeQuestion question, out SurfacePoint found) =>
            TryClosest(collider, pose, question, out found, out _);

        /// <summary>False where no point is within reach, or the kind of collider is not supported.</summary>
        /// <param name="hit">The ray hit that found the point; null where no ray was needed.</param>
        public static bool TryClosest(Collider collider, in RigidPose pose, in ProbeQuestion question,
            out SurfacePoint found, out RaycastHit? hit)
        {
            hit = null;
            Double3 tip = pose.PointToLocal(question.TipMetres);
            Double3 scale = collider.transform.lossyScale.ToDouble();
            switch (collider)
            {
                case BoxCollider box:
                    found = OnBox(box, tip, scale, question);
                    break;
                case SphereCollider sphere:
                    found = OnSphere(sphere, tip, scale, question);
                    break;
                case CapsuleCollider capsule:
                    found = OnCapsule(capsule, tip, scale, question);
                    break;
                case CharacterController controller:
                    found = OnController(controller, tip, scale, question);
                    break;
                case MeshCollider mesh when mesh.convex && ConvexProbe.TryOutside(mesh, pose, question, out found):
                    break;
                case MeshCollider _:
                case TerrainCollider _:
                    bool isNear = RayProbe.TryClosest(collider, pose, question, out found, out RaycastHit place);
                    hit = place;
                    return isNear;
                default:
                    found = default;
                    return false;
            }
            return found.SignedDistanceMetres <= question.ReachMetres;
        }

        private static SurfacePoint OnBox(BoxCollider box, Double3 tip, Double3 scale, in ProbeQuestion question)
        {
            Double3 centre = Centre(box.center, scale);
            Double3 size = Double3.Scale(box.size.ToDouble(), scale).Absolute;
            return Moved(
                Shapes.OnBox(size, tip - centre, question.PreviousLocalNormal, question.FaceMarginMetres), centre);
        }

        private static SurfacePoint OnSphere(
            SphereCollider sphere, Double3 tip, Double3 scale, in ProbeQuestion question)
        {
            Double3 centre = Centre(sphere.center, scale);
            double radius = sphere.radius * scale.Absolute.Largest;
            return Moved(Shapes.OnSphere(radius, tip - centre, question.PreviousLocalNormal), centre);
        }

        private static SurfacePoint OnCapsule(
            CapsuleCollider capsule, Double3 tip, Double3 scale, in ProbeQuestion question)
        {
            int axis = capsule.direction;
            Double3 size = scale.Absolute;
            double radius = capsule.radius * size.With(axis, 0.0).Largest;
            Double3 centre = Centre(capsule.center, scale);
            Double3? previous = question.PreviousLocalNormal;
            // Shapes.OnCapsule expects the axis along y: swap that coordinate before and after.
            SurfacePoint upright = Shapes.OnCapsule(radius, capsule.height * size[axis], Swapped(tip - centre, axis),
                previous.HasValue ? Swapped(previous.Value, axis) : (Double3?)null);
            return new SurfacePoint(Swapped(upright.PointMetres, axis) + centre, Swapped(upright.Normal, axis),
                upright.SignedDistanceMetres);
        }

        private static SurfacePoint OnController(
            CharacterController controller, Double3 tip, Double3 scale, in ProbeQuestion question)
        {
            Double3 size = scale.Absolute;
            Double3 centre = Centre(controller.center, scale);
            return Moved(Shapes.OnCapsule(controller.radius * Math.Max(size.X, size.Z), controller.height * size.Y,
                tip - centre, question.PreviousLocalNormal), centre);
        }

        private static Double3 Centre(Vector3 centre, Double3 scale) => Double3.Scale(centre.ToDouble(), scale);

        private static SurfacePoint Moved(in SurfacePoint point, Double3 by) =>
            new SurfacePoint(point.PointMetres + by, point.Normal, point.SignedDistanceMetres);

        private static Double3 Swapped(Double3 vector, int axis) => axis == 0
            ? new Double3(vector.Y, vector.X, vector.Z)
            : axis == 2 ? new Double3(vector.X, vector.Z, vector.Y) : vector;
    }
}
