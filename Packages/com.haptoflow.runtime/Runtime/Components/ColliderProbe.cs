#nullable enable
using System;
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>What a probe needs to know of the tip.</summary>
    internal readonly struct ProbeQuestion
    {
        public readonly Double3 TipMetres;

        /// <summary>Surfaces farther away play no part.</summary>
        public readonly double ReachMetres;

        /// <summary>Of the last frame's contact with this collider, in its local frame.</summary>
        public readonly Double3? PreviousLocalNormal;

        /// <summary>Where the tip was a frame ago.</summary>
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

    /// <summary>The place on a collider nearest to the tip, where the collider is drawn: the physics engine may still
    /// have it where it was a step ago. Main thread, no garbage.</summary>
    internal static class ColliderProbe
    {
        /// <summary>A kind of collider that a tip can feel.</summary>
        public static bool IsFeltKind(Collider collider) =>
            collider is BoxCollider || collider is SphereCollider || collider is CapsuleCollider ||
            collider is CharacterController || collider is MeshCollider || collider is TerrainCollider;

        /// <summary>Where the collider's local frame is. Character controllers and terrains stand upright whatever
        /// their
        /// transform says.</summary>
        public static RigidPose PoseOf(Collider collider) =>
            collider is CharacterController || collider is TerrainCollider
            ? Conversions.PoseOf(collider.transform.position, Quaternion.identity)
            : Conversions.PoseOf(collider.transform);

        /// <summary>False where nothing is near enough, or the collider is of a kind that cannot be felt.</summary>
        public static bool TryClosest(
            Collider collider, in RigidPose pose, in ProbeQuestion question, out SurfacePoint found) =>
            TryClosest(collider, pose, question, out found, out _);

        /// <summary>False where nothing is near enough, or the collider is of a kind that cannot be felt.</summary>
        /// <param name="hit">Of the ray that found the place; null where no ray did.</param>
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
            // The formula's capsule lies along y: swapping two coordinates takes it there and back.
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
