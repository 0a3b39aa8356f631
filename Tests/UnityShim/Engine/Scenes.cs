using System;
using System.Collections.Generic;
using System.Linq;
using UnityEngine.SceneManagement;
using UnityShim;

namespace UnityEngine.SceneManagement
{
    [System.Flags]
    public enum LocalPhysicsMode
    {
        None = 0x0,
        Physics2D = 0x1,
        Physics3D = 0x2,
    }

    public struct CreateSceneParameters
    {
        public CreateSceneParameters(LocalPhysicsMode physicsMode) => localPhysicsMode = physicsMode;

        public LocalPhysicsMode localPhysicsMode { get; set; }
    }

    /// <summary>A scene. The default value is the scene that the shim opens.</summary>
    public partial struct Scene
    {
        internal int Number;

        /// <summary>Number of the world of bodies that the scene has; 0 for the one that scenes share.</summary>
        internal int PhysicsNumber;

        public int buildIndex => Number == 0 ? 0 : -1;

        public static bool operator ==(Scene lhs, Scene rhs) => lhs.Number == rhs.Number;

        public static bool operator !=(Scene lhs, Scene rhs) => !(lhs == rhs);

        public override bool Equals(object? other) => other is Scene scene && this == scene;

        public override int GetHashCode() => Number;

        public GameObject[] GetRootGameObjects()
        {
            Scene scene = this;
            return World.AllObjects.Where(each => each.transform.parent is null && each.scene == scene).ToArray();
        }

        public void GetRootGameObjects(List<GameObject> rootGameObjects)
        {
            rootGameObjects.Clear();
            for (int index = 0; index < World.AllObjects.Count; ++index)
            {
                GameObject each = World.AllObjects[index];
                if (each.transform.parent is null && each.scene == this)
                {
                    rootGameObjects.Add(each);
                }
            }
        }
    }

    public partial class SceneManager
    {
        private static int count;

        public static event Events.UnityAction<Scene>? sceneUnloaded;

        public static Scene CreateScene(string sceneName, CreateSceneParameters parameters) => new Scene
        {
            Number = ++count,
            PhysicsNumber = (parameters.localPhysicsMode & LocalPhysicsMode.Physics3D) != 0 ? count : 0,
        };

        internal static void AnnounceUnloaded(Scene scene) => sceneUnloaded?.Invoke(scene);

        public static void MoveGameObjectToScene(GameObject go, Scene scene) => go.OwnScene = scene;
    }
}

namespace UnityEngine
{
    public partial struct PhysicsScene : IEquatable<PhysicsScene>
    {
        internal int Number;

        public bool Equals(PhysicsScene other) => Number == other.Number;

        public int OverlapSphere(Vector3 position, float radius, Collider[] results, int layerMask,
            QueryTriggerInteraction queryTriggerInteraction)
        {
            World.RequireMainThread();
            return PhysicsWorld.Overlap(Number, position, position, radius, results, layerMask, queryTriggerInteraction);
        }

        public int OverlapCapsule(Vector3 point0, Vector3 point1, float radius, Collider[] results, int layerMask,
            QueryTriggerInteraction queryTriggerInteraction)
        {
            World.RequireMainThread();
            return PhysicsWorld.Overlap(Number, point0, point1, radius, results, layerMask, queryTriggerInteraction);
        }

        public bool Raycast(Vector3 origin, Vector3 direction, out RaycastHit hitInfo, float maxDistance,
            int layerMask, QueryTriggerInteraction queryTriggerInteraction)
        {
            World.RequireMainThread();
            return PhysicsRays.Cast(Number, new Ray(origin, direction), out hitInfo, maxDistance, layerMask,
                queryTriggerInteraction);
        }
    }

    public static class PhysicsSceneExtensions
    {
        public static PhysicsScene GetPhysicsScene(this Scene scene) =>
            new PhysicsScene { Number = scene.PhysicsNumber };
    }
}
