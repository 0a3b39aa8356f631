using System;
using UnityEngine;

namespace UnityShim
{
    /// <summary>Nearest points and ray hits on colliders: by formula for simple shapes, by triangle for meshes and
    /// terrains.</summary>
    internal static class Geometry
    {
        /// <summary>Whether a sphere that is swept from one point to another reaches a collider, where physics holds
        /// it. The sweep goes in steps of half a radius.</summary>
        public static bool Reaches(Collider collider, Vector3 from, Vector3 to, float radius)
        {
            int steps = (int)Math.Ceiling(Vector3.Distance(from, to) / (0.5f * radius));
            for (int step = 0; step <= steps; ++step)
            {
                if (Reaches(collider, steps == 0 ? from : Vector3.Lerp(from, to, (float)step / steps), radius))
                {
                    return true;
                }
            }
            return false;
        }

        private static bool Reaches(Collider collider, Vector3 centre, float radius)
        {
            Vector3 nearest = collider is MeshCollider || collider is TerrainCollider
                ? Triangles.Closest(collider, centre, collider.PhysicsPosition, collider.PhysicsRotation)
                : ClosestPoint(collider, centre, collider.PhysicsPosition, collider.PhysicsRotation);
            return Vector3.Distance(nearest, centre) <= radius;
        }

        /// <summary>The nearest point of a shape; the point itself if it is inside. Convex shapes only, as in Unity.
        /// </summary>
        public static Vector3 ClosestPoint(Collider collider, Vector3 point, Vector3 position, Quaternion rotation)
        {
            Vector3 scale = collider.transform.lossyScale;
            Vector3 local = Quaternion.Inverse(rotation) * (point - position);
            Vector3 found = collider switch
            {
                BoxCollider box => InBox(local - Vector3.Scale(box.center, scale), Vector3.Scale(box.size, scale)) +
                    Vector3.Scale(box.center, scale),
                SphereCollider sphere => AroundSegment(local, Vector3.Scale(sphere.center, scale), Vector3.zero,
                    sphere.radius * Largest(scale)),
                CapsuleCollider capsule => OnCapsule(capsule, local, scale),
                CharacterController controller => AroundSegment(local, Vector3.Scale(controller.center, scale),
                    Vector3.up * Math.Max(0f, 0.5f * controller.height * scale.y - controller.radius * scale.x),
                    controller.radius * scale.x),
                MeshCollider { convex: true } mesh => Quaternion.Inverse(rotation) *
                    (Triangles.ClosestOfConvex(mesh, point, position, rotation) - position),
                _ => throw new NotSupportedException("ClosestPoint takes box, sphere, capsule and convex mesh colliders"),
            };
            return position + rotation * found;
        }

        public static bool Raycast(Collider collider, Ray ray, float maxDistance, out RaycastHit hit) =>
            collider is MeshCollider || collider is TerrainCollider
                ? Triangles.Raycast(collider, ray, maxDistance, out hit)
                : throw new NotSupportedException("the shim casts rays at meshes and terrains only");

        private static Vector3 OnCapsule(CapsuleCollider capsule, Vector3 local, Vector3 scale)
        {
            Vector3 axis = capsule.direction == 0 ? Vector3.right : capsule.direction == 1 ? Vector3.up : Vector3.forward;
            float along = Math.Abs(Vector3.Dot(axis, scale));
            Vector3 across = Vector3.Scale(Vector3.one - axis, scale);
            float radius = capsule.radius * Largest(across);
            float half = Math.Max(0f, 0.5f * capsule.height * along - radius);
            return AroundSegment(local, Vector3.Scale(capsule.center, scale), half * axis, radius);
        }

        private static Vector3 InBox(Vector3 point, Vector3 size) => new Vector3(
            Mathf.Clamp(point.x, -0.5f * Math.Abs(size.x), 0.5f * Math.Abs(size.x)),
            Mathf.Clamp(point.y, -0.5f * Math.Abs(size.y), 0.5f * Math.Abs(size.y)),
            Mathf.Clamp(point.z, -0.5f * Math.Abs(size.z), 0.5f * Math.Abs(size.z)));

        private static Vector3 AroundSegment(Vector3 point, Vector3 centre, Vector3 halfAxis, float radius)
        {
            float squared = halfAxis.sqrMagnitude;
            float share = squared > 0f ? Mathf.Clamp(Vector3.Dot(point - centre, halfAxis) / squared, -1f, 1f) : 0f;
            Vector3 core = centre + share * halfAxis;
            Vector3 offset = point - core;
            return offset.magnitude <= radius ? point : core + offset * (radius / offset.magnitude);
        }

        private static float Largest(Vector3 vector) =>
            Math.Max(Math.Abs(vector.x), Math.Max(Math.Abs(vector.y), Math.Abs(vector.z)));
    }
}
