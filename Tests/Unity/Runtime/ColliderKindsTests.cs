#nullable enable
using System.Collections;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;

namespace HaptoFlow.Tests
{
    /// <summary>A tip of 2 mm radius that presses 1 mm into each kind of collider.</summary>
    public sealed class ColliderKindsTests : SceneTest
    {
        [UnityTest]
        public IEnumerator ABoxWithOffsetScaleAndRotationIsTouchedAtItsSurface()
        {
            HapticSurface surface = Tagged<BoxCollider>("wood", box =>
            {
                box.size = new Vector3(0.1f, 0.2f, 0.1f);
                box.center = new Vector3(0f, 0.05f, 0f);
            });
            surface.transform.localScale = new Vector3(2f, 0.5f, 1f);
            surface.transform.rotation = Quaternion.AngleAxis(90f, Vector3.forward);
            // The top of the box, at local y = 0.15 * 0.5, faces -x.
            return Presses(surface, new Vector3(-0.075f, 0f, 0f), Vector3.left);
        }

        [UnityTest]
        public IEnumerator DeepBelowTheRimOfAStepWithoutAnUndersideTheWallBesideIsTouched()
        {
            Tagged<MeshCollider>("wood", mesh => mesh.sharedMesh = TestMeshes.Step());
            HapticStylus stylus = StylusAlong(seconds =>
                new Vector3(-0.002f, Mathf.Max(-0.008f, 0.01f - 0.1f * (float)seconds), 0f));
            yield return Frames(60);
            Assert.That(stylus.IsTouching, Is.True);
            Assert.That(stylus.Contact.Normal.x, Is.EqualTo(1f).Within(1e-3f));
            Assert.That(stylus.Contact.TouchCounter, Is.EqualTo(1u));
        }

        [UnityTest]
        public IEnumerator ASphereHasTheRadiusOfItsLargestScale()
        {
            HapticSurface surface = Tagged<SphereCollider>("wood", sphere => sphere.radius = 0.05f);
            surface.transform.localScale = new Vector3(1f, 2f, 1f);
            return Presses(surface, new Vector3(0.1f, 0f, 0f), Vector3.right);
        }

        [UnityTest]
        public IEnumerator ACapsuleAlongXIsTouchedAtItsSide()
        {
            HapticSurface surface = Tagged<CapsuleCollider>("wood", capsule =>
            {
                capsule.direction = 0;
                capsule.radius = 0.02f;
                capsule.height = 0.2f;
                capsule.center = new Vector3(0f, 0.01f, 0f);
            });
            return Presses(surface, new Vector3(0.05f, 0.03f, 0f), Vector3.up);
        }

        [UnityTest]
        public IEnumerator ACapsuleAlongZIsTouchedAtItsCap()
        {
            HapticSurface surface = Tagged<CapsuleCollider>("wood", capsule =>
            {
                capsule.direction = 2;
                capsule.radius = 0.02f;
                capsule.height = 0.2f;
            });
            return Presses(surface, new Vector3(0f, 0f, -0.1f), Vector3.back);
        }

        [UnityTest]
        public IEnumerator ACharacterControllerStaysUprightWhateverItsRotation()
        {
            HapticSurface surface = Tagged<CharacterController>("wood", character =>
            {
                character.radius = 0.3f;
                character.height = 1.8f;
            });
            surface.transform.rotation = Quaternion.AngleAxis(90f, Vector3.forward);
            return Presses(surface, new Vector3(0.3f, 0.2f, 0f), Vector3.right);
        }

        [UnityTest]
        public IEnumerator AConvexMesh() => Presses(Tagged<MeshCollider>("wood", mesh =>
        {
            mesh.sharedMesh = TestMeshes.Box(0.1f);
            mesh.convex = true;
        }), new Vector3(0.01f, 0.05f, 0.02f), Vector3.up);

        [UnityTest]
        public IEnumerator AGutterMeshIsTouchedAtItsFloorAndItsWall()
        {
            HapticSurface surface = Tagged<MeshCollider>("wood", mesh => mesh.sharedMesh = TestMeshes.Gutter());
            yield return Presses(surface, Vector3.zero, Vector3.up);
            yield return Presses(surface, new Vector3(0.01f, 0.012f, 0f), Vector3.left, 0.015f);
        }

        [UnityTest]
        public IEnumerator ATerrain()
        {
            HapticSurface surface = Tagged<TerrainCollider>("stone", terrain =>
            {
                terrain.terrainData = new TerrainData { heightmapResolution = 33, size = new Vector3(2f, 1f, 2f) };
                var heights = new float[33, 33];
                for (int row = 0; row < 33; ++row)
                {
                    for (int column = 0; column < 33; ++column)
                    {
                        heights[row, column] = 0.5f * column / 32f;
                    }
                }
                terrain.terrainData.SetHeights(0, 0, heights);
            });
            // A slope of 0.5 m over 2 m.
            Vector3 normal = new Vector3(-0.25f, 1f, 0f).normalized;
            return Presses(surface, new Vector3(1.01f, 0.2525f, 0.93f), normal);
        }

        [UnityTest]
        public IEnumerator ATriggerIsNotFelt()
        {
            Tagged<BoxCollider>("wood", box => box.isTrigger = true);
            HapticStylus stylus = StylusAlong(_ => new Vector3(0f, 0.501f, 0f));
            yield return Frames(2);
            Assert.That(stylus.IsTouching, Is.False);
        }

        /// <summary>Moves the tip along the normal and presses 1 mm, then 12 mm deep.</summary>
        private IEnumerator Presses(HapticSurface surface, Vector3 point, Vector3 normal, float fromMetres = 0.03f)
        {
            HapticStylus stylus = StylusAlong(seconds =>
            {
                float coming = Mathf.Max(0.001f, fromMetres - 0.2f * (float)seconds);
                float height = seconds < 0.6 ? coming : -0.01f;
                return point + normal * height;
            });
            var mover = stylus.GetComponent<PathMover>();
            yield return null;
            Assert.That(stylus.IsTouching, Is.False, "before it comes down");
            yield return Until(mover, 0.55);
            Check(stylus, surface, 0.001f, normal, point);
            yield return Until(mover, 0.8);
            Check(stylus, surface, 0.012f, normal, point);
            Object.DestroyImmediate(stylus.gameObject);
        }

        private static void Check(
            HapticStylus stylus, HapticSurface surface, float penetrationMetres, Vector3 normal, Vector3 point)
        {
            Assert.That(stylus.IsTouching, Is.True, $"{penetrationMetres} m deep");
            Assert.That(stylus.Contact.Surface, Is.SameAs(surface));
            Assert.That(stylus.Contact.PenetrationMetres, Is.EqualTo(penetrationMetres).Within(2e-5f));
            Assert.That(Vector3.Distance(stylus.Contact.Normal, normal), Is.LessThan(1e-3f), stylus.Contact.Normal.ToString());
            Assert.That(Vector3.Distance(stylus.Contact.Point, point), Is.LessThan(1e-4f), stylus.Contact.Point.ToString());
        }
    }
}
