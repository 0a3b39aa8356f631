using System;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.SceneManagement;
using UnityShim;

namespace HaptoFlow.ShimTests
{
    /// <summary>What is around a tip: furniture without a material, and scenes with a physics world of their own.
    /// </summary>
    public sealed class NearbyObjectsTests : SceneTest
    {
        [Test]
        public void FurnitureAroundATipIsSearchedForASurfaceInOneOfThirtyFrames()
        {
            Transform place = Make("room").transform;
            for (int level = 0; level < 8; ++level)
            {
                GameObject inner = Make("furniture");
                inner.transform.SetParent(place, false);
                inner.AddComponent<BoxCollider>().size = new Vector3(0.1f, 0.1f, 0.1f);
                place = inner.transform;
            }
            StylusAlong(_ => new Vector3(0f, 0.051f, 0f));
            World.Frames(2);
            ComponentSearchCount<HapticSurface>.Searches = 0;
            World.Frames(90);
            // One search asks the collider's object and each above it: 2 to 9 objects.
            Assert.That(ComponentSearchCount<HapticSurface>.Searches, Is.InRange(1, 4 * (2 + 3 + 4 + 5 + 6 + 7 + 8 + 9)));
        }

        [Test]
        public void AmongTooManyCollidersTheTouchedOneIsFeltAndOneWarningIsWritten()
        {
            for (int index = 0; index < 40; ++index)
            {
                Tagged<BoxCollider>("stone", box => box.size = new Vector3(0.01f, 0.01f, 0.01f))
                    .transform.position = new Vector3(0.03f, 0.03f, 0f);
            }
            HapticSurface board = Board();
            HapticStylus pen = StylusAlong(seconds => new Vector3(0f, seconds < 0.3 ? 0.05f : 0.001f, 0f));
            pen.TipRadiusMetres = 0.003f;
            World.Frames(90);
            Assert.That(pen.IsTouching, Is.True);
            Assert.That(pen.Contact.Surface, Is.SameAs(board));
            Assert.That(Log.Count("tagged colliders", LogType.Warning), Is.EqualTo(1));
        }

        [Test]
        public void DestroyedFurnitureDoesNotStayRememberedForever()
        {
            var untagged = new UntaggedColliders();
            GameObject first = Make("first");
            Collider remembered = first.AddComponent<BoxCollider>();
            untagged.Remember(remembered);
            Assert.That(untagged.Holds(remembered), Is.True);
            for (int index = 0; index < 1024; ++index)
            {
                untagged.Remember(first.AddComponent<BoxCollider>());
            }
            Assert.That(untagged.Holds(remembered), Is.False);
        }

        [Test]
        public void AStylusFeelsTheObjectsOfItsOwnPhysicsSceneOnly()
        {
            FinishLoading();
            Scene other = SceneManager.CreateScene(
                "Apart", new CreateSceneParameters(LocalPhysicsMode.Physics3D));
            HapticSurface here = Board("wood");
            HapticSurface there = Board("fur");
            SceneManager.MoveGameObjectToScene(there.gameObject, other);
            HapticStylus stylus = Resting();
            World.Frames(3);
            Assert.That(stylus.IsTouching, Is.True);
            Assert.That(stylus.Contact.Surface, Is.SameAs(here));

            SceneManager.MoveGameObjectToScene(stylus.gameObject, other);
            World.Frames(3);
            Assert.That(stylus.Contact.Surface, Is.SameAs(there));
        }

        [Test]
        public void ASceneLoadedWithoutAPhysicsWorldOfItsOwnIsFeltFromTheOthers()
        {
            FinishLoading();
            Scene additive = SceneManager.CreateScene("Added", new CreateSceneParameters(LocalPhysicsMode.None));
            HapticSurface board = Board("wood");
            SceneManager.MoveGameObjectToScene(board.gameObject, additive);
            HapticStylus stylus = Resting();
            World.Frames(3);
            Assert.That(stylus.IsTouching, Is.True);
        }
    }

    /// <summary>The cost of mesh colliders, and where they are felt.</summary>
    public sealed class MeshProbeTests : SceneTest
    {
        [SetUp]
        public void ResetTheRayCount() => RayCount.Rays = 0;

        [TearDown]
        public void RestoreFrontFacesOnly() => Physics.queriesHitBackfaces = false;

        [Test]
        public void AMeshWhoseBoundsAreOutOfReachCastsNoRay()
        {
            MeshBox(false);
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0.001f * (float)seconds, 0.01f, 0f));
            World.Frames(20);
            Assert.That(stylus.IsTouching, Is.False);
            Assert.That(RayCount.Rays, Is.Zero);
        }

        [Test]
        public void ATipOutsideAConvexMeshCastsNoRayAndIsExact()
        {
            MeshBox(true);
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0.02f * (float)seconds, 0.001f, 0f));
            World.Frames(20);
            Assert.That(stylus.IsTouching, Is.True);
            Assert.That(stylus.Contact.PenetrationMetres, Is.EqualTo(0.001f).Within(1e-5f));
            Assert.That(Vector3.Dot(stylus.Contact.Normal, Vector3.up), Is.EqualTo(1f).Within(1e-4f));
            Assert.That(RayCount.Rays, Is.Zero);
        }

        [TestCase(false)]
        [TestCase(true)]
        public void TheBackFaceSettingOfPhysicsChangesNothing(bool hitsBacks)
        {
            Physics.queriesHitBackfaces = hitsBacks;
            Tagged<MeshCollider>("wood", mesh => mesh.sharedMesh = ReliefTests.Sheet());
            HapticStylus below = StylusAlong(seconds => new Vector3(0.01f * (float)seconds, -0.001f - 0.02f, 0f));
            HapticStylus rising = StylusAlong(seconds =>
                new Vector3(0f, Math.Min(-0.0022f, -0.03f + 0.05f * (float)seconds), 0f));
            HapticStylus above = StylusAlong(seconds => new Vector3(0.01f * (float)seconds, 0.001f, 0f));
            World.Frames(90);
            Assert.That(above.Contact.PenetrationMetres, Is.EqualTo(0.001f).Within(1e-5f));
            Assert.That(Vector3.Dot(above.Contact.Normal, Vector3.up), Is.EqualTo(1f).Within(1e-4f));
            Assert.That(below.IsTouching, Is.False);
            Assert.That(rising.IsTouching && Vector3.Dot(rising.Contact.Normal, Vector3.up) < 0f, Is.False,
                "a back face must not push downwards");
            Assert.That(Physics.queriesHitBackfaces, Is.EqualTo(hitsBacks), "the project's setting does not change");
        }

        /// <summary>Creates a closed box of 20 cm whose top is the plane y = 0.</summary>
        private void MeshBox(bool convex)
        {
            HapticSurface box = Tagged<MeshCollider>("wood", mesh =>
            {
                mesh.sharedMesh = TestMeshes.Box(0.2f);
                mesh.convex = convex;
            });
            box.transform.position = new Vector3(0f, -0.1f, 0f);
            Physics.SyncTransforms();
        }
    }
}
