using System;
using UnityShim;

namespace UnityEngine
{
    public class Rigidbody : Component
    {
        internal BodyState State = null!;

        public bool isKinematic { get; set; }
        public RigidbodyInterpolation interpolation { get; set; }

        public Vector3 position
        {
            get => State.Position;
            set => State.Place(value, State.Rotation);
        }

        public Quaternion rotation
        {
            get => State.Rotation;
            set => State.Place(State.Position, value);
        }

        /// <summary>Moves the body in the next physics step.</summary>
        public void MovePosition(Vector3 position) => State.MoveTo(position);
    }

#if UNITY_6000_0_OR_NEWER
    public class PhysicsMaterial : Object
    {
        public PhysicsMaterial(string name) => this.name = name;
    }
#else
    public class PhysicMaterial : Object
    {
        public PhysicMaterial(string name) => this.name = name;
    }
#endif

    public class Collider : Component
    {
        internal Vector3 PhysicsPosition;
        internal Quaternion PhysicsRotation = Quaternion.identity;

        public bool enabled { get; set; } = true;
        public bool isTrigger { get; set; }
#if UNITY_6000_0_OR_NEWER
        public PhysicsMaterial? sharedMaterial { get; set; }
#else
        public PhysicMaterial? sharedMaterial { get; set; }
#endif

        public Rigidbody? attachedRigidbody => BodyState.Above(transform);
        public Vector3 ClosestPoint(Vector3 position) => Physics.ClosestPoint(position, this, PhysicsPosition, PhysicsRotation);

        /// <summary>The bounds in world space, at the pose of the last physics step. The shim has them for meshes and
        /// terrains only.</summary>
        public Bounds bounds => Triangles.BoundsOf(this);

        public bool Raycast(Ray ray, out RaycastHit hitInfo, float maxDistance)
        {
            ++RayCount.Rays;
            return Geometry.Raycast(this, ray, maxDistance, out hitInfo);
        }
    }

    public class BoxCollider : Collider
    {
        public Vector3 center { get; set; }
        public Vector3 size { get; set; } = Vector3.one;
    }

    public class SphereCollider : Collider
    {
        public Vector3 center { get; set; }
        public float radius { get; set; } = 0.5f;
    }

    public class CapsuleCollider : Collider
    {
        public Vector3 center { get; set; }
        public float radius { get; set; } = 0.5f;
        public float height { get; set; } = 2f;

        /// <summary>The axis: 0, 1, 2 for x, y, z.</summary>
        public int direction { get; set; } = 1;
    }

    public class CharacterController : Collider
    {
        public Vector3 center { get; set; }
        public float radius { get; set; } = 0.5f;
        public float height { get; set; } = 2f;
    }

    public class MeshCollider : Collider
    {
        public Mesh? sharedMesh { get; set; }
        public bool convex { get; set; }
    }

    public class TerrainCollider : Collider
    {
        public TerrainData? terrainData { get; set; }
    }

    public partial class Physics
    {
        public static bool queriesHitBackfaces { get; set; }

        public static void SyncTransforms() => PhysicsWorld.Sync();

        public static Vector3 ClosestPoint(Vector3 point, Collider collider, Vector3 position, Quaternion rotation) =>
            Geometry.ClosestPoint(collider, point, position, rotation);
    }
}
