using UnityEngine;

namespace UnityShim
{
    /// <summary>Rays through a physics scene.</summary>
    internal static class PhysicsRays
    {
        private const float HitMetres = 1e-5f;
        private const int MaximumSteps = 512;
        private static readonly Collider[] Found = new Collider[1024];

        /// <param name="world">Number of the physics scene.</param>
        public static bool Cast(int world, Ray ray, out RaycastHit hitInfo, float maxDistance, int layerMask,
            QueryTriggerInteraction queryTriggerInteraction)
        {
            hitInfo = default;
            bool hasHit = false;
            int count = PhysicsWorld.Overlap(world, ray.origin, ray.origin, maxDistance, Found, layerMask, queryTriggerInteraction);
            for (int index = 0; index < count; ++index)
            {
                Collider collider = Found[index];
                bool isConvex = !(collider is TerrainCollider) && !(collider is MeshCollider { convex: false });
                bool hits = isConvex
                    ? Meets(collider, ray, maxDistance, out RaycastHit hit)
                    : collider.Raycast(ray, out hit, maxDistance);
                if (hits && (!hasHit || hit.distance < hitInfo.distance))
                {
                    hasHit = true;
                    hitInfo = hit;
                }
            }
            return hasHit;
        }

        /// <summary>Advances along the ray by the free distance in each step (sphere tracing). As in Unity, a ray from
        /// inside a collider does not hit it.</summary>
        private static bool Meets(Collider collider, Ray ray, float maxDistance, out RaycastHit hit)
        {
            hit = default;
            float distance = 0f;
            Vector3 outward = Vector3.zero;
            for (int step = 0; step < MaximumSteps && distance <= maxDistance; ++step)
            {
                Vector3 place = ray.origin + distance * ray.direction;
                Vector3 nearest = collider.ClosestPoint(place);
                float free = Vector3.Distance(place, nearest);
                if (free < HitMetres)
                {
                    hit.point = nearest;
                    hit.normal = outward;
                    hit.distance = distance;
                    return outward != Vector3.zero;
                }
                outward = (place - nearest).normalized;
                distance += free;
            }
            return false;
        }
    }
}
