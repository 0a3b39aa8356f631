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
}
