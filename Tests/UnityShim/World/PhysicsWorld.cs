using System.Collections.Generic;
using UnityEngine;

namespace UnityShim
{
    /// <summary>The poses of colliders in the last physics step, which can differ from those of their transforms.
    /// </summary>
    internal static class PhysicsWorld
    {
        private static readonly List<Collider> Colliders = new List<Collider>();
        private static readonly List<BodyState> Bodies = new List<BodyState>();

        public static void Added(Component component)
        {
            if (component is Rigidbody body)
            {
                body.State = new BodyState(body);
                Bodies.Add(body.State);
            }
            if (component is Collider collider)
            {
                Colliders.Add(collider);
                Sync(collider);
            }
        }

        public static void Removed(Component component)
        {
            if (component is Rigidbody body)
            {
                Bodies.Remove(body.State);
            }
            if (component is Collider collider)
            {
                Colliders.Remove(collider);
            }
        }

        public static void Step()
        {
            for (int index = 0; index < Bodies.Count; ++index)
            {
                Bodies[index].Step();
                Bodies[index].Show(1f);
            }
            Sync();
        }

        public static void ShowBodies()
        {
            float share = (float)((Clock.Seconds - Clock.FixedSeconds) / Clock.FixedStepSeconds);
            for (int index = 0; index < Bodies.Count; ++index)
            {
                Bodies[index].TakeTransform();
                Bodies[index].Show(share);
            }
        }

        public static void Sync()
        {
            for (int index = 0; index < Colliders.Count; ++index)
            {
                Sync(Colliders[index]);
            }
        }

        /// <param name="world">Number of the physics scene.</param>
        public static int Overlap(int world, Vector3 from, Vector3 to, float radius, Collider[] results, int layerMask,
            QueryTriggerInteraction triggers)
        {
            int count = 0;
            for (int index = 0; index < Colliders.Count && count < results.Length; ++index)
            {
                Collider collider = Colliders[index];
                bool isCandidate = collider.enabled && collider.gameObject.activeInHierarchy &&
                    collider.gameObject.scene.PhysicsNumber == world &&
                    (layerMask & (1 << collider.gameObject.layer)) != 0 &&
                    (!collider.isTrigger || triggers != QueryTriggerInteraction.Ignore);
                if (isCandidate && Geometry.Reaches(collider, from, to, radius))
                {
                    results[count++] = collider;
                }
            }
            return count;
        }

        private static void Sync(Collider collider) =>
            collider.transform.GetPositionAndRotation(out collider.PhysicsPosition, out collider.PhysicsRotation);
    }

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

    /// <summary>The state of a rigid body: its pose in the last and in the previous physics step, and the pose that
    /// physics last gave to its transform.</summary>
    internal sealed class BodyState
    {
        private readonly Rigidbody body;
        private Vector3 previousPosition;
        private Quaternion previousRotation;
        private Vector3 shownPosition;
        private Quaternion shownRotation;
        private Vector3? goal;

        public BodyState(Rigidbody body)
        {
            this.body = body;
            Place(body.transform.position, body.transform.rotation);
        }

        public Vector3 Position { get; private set; }

        public Quaternion Rotation { get; private set; }

        public static Rigidbody? Above(Transform? place)
        {
            for (; place is not null; place = place.parent)
            {
                if (place.gameObject.TryGetComponent(out Rigidbody found))
                {
                    return found;
                }
            }
            return null;
        }

        public void MoveTo(Vector3 position) => goal = position;

        public void Place(Vector3 position, Quaternion rotation)
        {
            Position = previousPosition = shownPosition = position;
            Rotation = previousRotation = shownRotation = rotation;
            body.transform.SetPositionAndRotation(position, rotation);
        }

        /// <summary>Moves the body to a transform that a script has moved.</summary>
        public void TakeTransform()
        {
            if (!body.transform.position.Equals(shownPosition) || !body.transform.rotation.Equals(shownRotation))
            {
                Place(body.transform.position, body.transform.rotation);
            }
        }

        public void Step()
        {
            TakeTransform();
            previousPosition = Position;
            previousRotation = Rotation;
            Position = goal ?? Position;
            goal = null;
        }

        /// <summary>An interpolated body is shown between its poses of the last two steps, one step late.</summary>
        public void Show(float share)
        {
            bool interpolated = body.interpolation == RigidbodyInterpolation.Interpolate;
            body.transform.SetPositionAndRotation(
                interpolated ? Vector3.Lerp(previousPosition, Position, share) : Position,
                interpolated ? Quaternion.Slerp(previousRotation, Rotation, share) : Rotation);
            shownPosition = body.transform.position;
            shownRotation = body.transform.rotation;
        }
    }

    /// <summary>Counts the queries of scripts to the physics engine.</summary>
    public static class RayCount
    {
        /// <summary>The number of rays cast at single colliders. Tests reset it.</summary>
        public static int Rays { get; set; }
    }

    /// <summary>Counts the searches of scripts for a kind of component.</summary>
    public static class ComponentSearchCount<T>
    {
        /// <summary>The number of calls of TryGetComponent. Tests reset it.</summary>
        public static int Searches { get; set; }
    }
}
