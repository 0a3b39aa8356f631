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
            HapticStylus stylus = StylusAlong(_ => new Vector3(0f, 0.001f, 0f));
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
            HapticStylus stylus = StylusAlong(_ => new Vector3(0f, 0.001f, 0f));
            World.Frames(3);
            Assert.That(stylus.IsTouching, Is.True);
        }
    }
}
