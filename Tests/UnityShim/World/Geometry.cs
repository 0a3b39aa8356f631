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

    /// <summary>Triangles of meshes and terrains. The corners of a front face run clockwise, as in Unity.</summary>
    internal static class Triangles
    {
        public static Vector3 Closest(Collider collider, Vector3 point, Vector3 position, Quaternion rotation)
        {
            Vector3 best = Vector3.one * 1e6f;
            int count = Count(collider);
            for (int index = 0; index < count; ++index)
            {
                Corners(collider, index, position, rotation, out Vector3 a, out Vector3 b, out Vector3 c);
                Vector3 candidate = ClosestOn(a, b, c, point);
                if ((candidate - point).sqrMagnitude < (best - point).sqrMagnitude)
                {
                    best = candidate;
                }
            }
            return best;
        }

        public static Vector3 ClosestOfConvex(Collider collider, Vector3 point, Vector3 position, Quaternion rotation)
        {
            bool outside = false;
            int count = Count(collider);
            for (int index = 0; index < count && !outside; ++index)
            {
                Corners(collider, index, position, rotation, out Vector3 a, out Vector3 b, out Vector3 c);
                outside = Vector3.Dot(point - a, Vector3.Cross(b - a, c - a)) > 0f;
            }
            return outside ? Closest(collider, point, position, rotation) : point;
        }

        public static bool Raycast(Collider collider, Ray ray, float maxDistance, out RaycastHit hit)
        {
            hit = default;
            float nearest = maxDistance;
            bool found = false;
            int count = Count(collider);
            for (int index = 0; index < count; ++index)
            {
                Corners(collider, index, collider.PhysicsPosition, collider.PhysicsRotation,
                    out Vector3 a, out Vector3 b, out Vector3 c);
                if (Hits(ray, a, b, c, out float distance) && distance <= nearest)
                {
                    nearest = distance;
                    found = true;
                    Vector3 front = Vector3.Cross(b - a, c - a) / Vector3.Cross(b - a, c - a).magnitude;
                    hit = new RaycastHit
                    {
                        point = ray.origin + distance * ray.direction,
                        // The normal of a back face that is hit points towards the ray.
                        normal = Vector3.Dot(front, ray.direction) > 0f ? -front : front,
                        distance = distance,
                        triangleIndex = collider is MeshCollider { convex: false } ? index : -1,
                    };
                    hit.textureCoord = TextureCoordinate(collider, index, a, b, c, hit.point);
                }
            }
            return found;
        }

        public static Bounds BoundsOf(Collider collider)
        {
            if (!(collider is MeshCollider) && !(collider is TerrainCollider))
            {
                throw new NotSupportedException("the shim knows bounds of meshes and terrains only");
            }
            Bounds bounds = new Bounds(collider.PhysicsPosition, Vector3.zero);
            int count = Count(collider);
            for (int index = 0; index < count; ++index)
            {
                Corners(collider, index, collider.PhysicsPosition, collider.PhysicsRotation,
                    out Vector3 a, out Vector3 b, out Vector3 c);
                bounds = index == 0 ? new Bounds(a, Vector3.zero) : bounds;
                bounds.Encapsulate(a);
                bounds.Encapsulate(b);
                bounds.Encapsulate(c);
            }
            return bounds;
        }

        /// <summary>The texture coordinates of a hit; 0 where Unity has none.</summary>
        private static Vector2 TextureCoordinate(
            Collider collider, int index, Vector3 a, Vector3 b, Vector3 c, Vector3 point)
        {
            if (!(collider is MeshCollider { convex: false } mesh) || mesh.sharedMesh!.uv.Length == 0 ||
                !mesh.sharedMesh.isReadable)
            {
                return default;
            }
            Vector3 whole = Vector3.Cross(b - a, c - a);
            float ofA = Vector3.Dot(Vector3.Cross(c - b, point - b), whole) / whole.sqrMagnitude;
            float ofB = Vector3.Dot(Vector3.Cross(a - c, point - c), whole) / whole.sqrMagnitude;
            int[] triangles = mesh.sharedMesh.triangles;
            Vector2 first = mesh.sharedMesh.uv[triangles[3 * index]];
            Vector2 second = mesh.sharedMesh.uv[triangles[3 * index + 1]];
            Vector2 third = mesh.sharedMesh.uv[triangles[3 * index + 2]];
            float ofC = 1f - ofA - ofB;
            return new Vector2(ofA * first.x + ofB * second.x + ofC * third.x,
                ofA * first.y + ofB * second.y + ofC * third.y);
        }

        private static int Count(Collider collider) => collider switch
        {
            MeshCollider mesh => mesh.sharedMesh == null ? 0 : mesh.sharedMesh.triangles.Length / 3,
            TerrainCollider terrain when terrain.terrainData != null =>
                2 * (terrain.terrainData.heightmapResolution - 1) * (terrain.terrainData.heightmapResolution - 1),
            _ => 0,
        };

        private static void Corners(Collider collider, int index, Vector3 position, Quaternion rotation,
            out Vector3 a, out Vector3 b, out Vector3 c)
        {
            if (collider is MeshCollider mesh)
            {
                Vector3 scale = collider.transform.lossyScale;
                int[] triangles = mesh.sharedMesh!.triangles;
                Vector3[] vertices = mesh.sharedMesh.vertices;
                a = position + rotation * Vector3.Scale(scale, vertices[triangles[3 * index]]);
                b = position + rotation * Vector3.Scale(scale, vertices[triangles[3 * index + 1]]);
                c = position + rotation * Vector3.Scale(scale, vertices[triangles[3 * index + 2]]);
                return;
            }
            TerrainData data = ((TerrainCollider)collider).terrainData!;
            int cell = index / 2;
            int x = cell % (data.heightmapResolution - 1);
            int z = cell / (data.heightmapResolution - 1);
            bool upper = index % 2 == 1;
            // Terrains ignore the rotation of their transform, as in Unity.
            a = position + (upper ? data.VertexAt(x + 1, z + 1) : data.VertexAt(x, z));
            b = position + (upper ? data.VertexAt(x + 1, z) : data.VertexAt(x, z + 1));
            c = position + (upper ? data.VertexAt(x, z + 1) : data.VertexAt(x + 1, z));
        }

        /// <summary>Hits front faces, and back faces if the project's physics settings say so (Moeller and Trumbore
        /// 1997).</summary>
        private static bool Hits(Ray ray, Vector3 a, Vector3 b, Vector3 c, out float distance)
        {
            distance = 0f;
            Vector3 normal = Vector3.Cross(b - a, c - a);
            float towards = -Vector3.Dot(ray.direction, normal);
            if (towards < 0f && Physics.queriesHitBackfaces)
            {
                normal = -normal;
                towards = -towards;
            }
            if (towards <= 1e-9f * normal.magnitude)
            {
                return false;
            }
            distance = Vector3.Dot(ray.origin - a, normal) / towards;
            if (distance < 0f)
            {
                return false;
            }
            Vector3 point = ray.origin + distance * ray.direction;
            float tolerance = -1e-6f * normal.sqrMagnitude;
            Vector3 winding = Vector3.Cross(b - a, c - a);
            return Vector3.Dot(Vector3.Cross(b - a, point - a), winding) >= tolerance &&
                Vector3.Dot(Vector3.Cross(c - b, point - b), winding) >= tolerance &&
                Vector3.Dot(Vector3.Cross(a - c, point - c), winding) >= tolerance;
        }

        /// <summary>The nearest point of a triangle, after Ericson, Real-Time Collision Detection, 5.1.5.</summary>
        private static Vector3 ClosestOn(Vector3 a, Vector3 b, Vector3 c, Vector3 point)
        {
            Vector3 ab = b - a;
            Vector3 ac = c - a;
            float abA = Vector3.Dot(ab, point - a);
            float acA = Vector3.Dot(ac, point - a);
            float abB = Vector3.Dot(ab, point - b);
            float acB = Vector3.Dot(ac, point - b);
            float abC = Vector3.Dot(ab, point - c);
            float acC = Vector3.Dot(ac, point - c);
            float areaA = abB * acC - abC * acB;
            float areaB = abC * acA - abA * acC;
            float areaC = abA * acB - abB * acA;
            if (areaA >= 0f && areaB >= 0f && areaC >= 0f && areaA + areaB + areaC > 0f)
            {
                float area = areaA + areaB + areaC;
                return a + ab * (areaB / area) + ac * (areaC / area);
            }
            Vector3 best = OnEdge(a, b, point);
            Vector3 second = OnEdge(b, c, point);
            Vector3 third = OnEdge(c, a, point);
            best = (second - point).sqrMagnitude < (best - point).sqrMagnitude ? second : best;
            return (third - point).sqrMagnitude < (best - point).sqrMagnitude ? third : best;
        }

        private static Vector3 OnEdge(Vector3 from, Vector3 to, Vector3 point)
        {
            Vector3 edge = to - from;
            return from + edge * Mathf.Clamp01(Vector3.Dot(point - from, edge) / edge.sqrMagnitude);
        }
    }
}
