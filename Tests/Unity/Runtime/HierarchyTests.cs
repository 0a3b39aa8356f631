#nullable enable
using System.Collections;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;

namespace HaptoFlow.Tests
{
    /// <summary>Colliders that are added, removed or moved below a surface without calling Refresh.</summary>
    public sealed class HierarchyTests : SceneTest
    {
        private HapticSurface parent = null!;
        private HapticStylus stylus = null!;

        [SetUp]
        public void MakeAParentOutOfReach()
        {
            parent = Tagged<SphereCollider>("wood", sphere => sphere.center = new Vector3(0f, 5f, 0f));
            stylus = StylusAlong(_ => new Vector3(0f, 0.051f, 0f));
        }

        [UnityTest]
        public IEnumerator AChildAddedLaterIsFeltAndListed()
        {
            yield return null;
            Cube().transform.SetParent(parent.transform, false);
            Assert.That(parent.Colliders.Count, Is.EqualTo(2));
            yield return null;
            Assert.That(Touched(), Is.SameAs(parent));
        }

        [UnityTest]
        public IEnumerator AColliderAddedToAGrandchildIsFelt()
        {
            GameObject child = Make("child");
            child.transform.SetParent(parent.transform, false);
            GameObject grandchild = Make("grandchild");
            grandchild.transform.SetParent(child.transform, false);
            yield return Frames(2);
            Assert.That(stylus.IsTouching, Is.False);
            grandchild.AddComponent<BoxCollider>().size = new Vector3(0.1f, 0.1f, 0.1f);
            yield return null;
            Assert.That(Touched(), Is.SameAs(parent));
            Assert.That(parent.Colliders.Count, Is.EqualTo(2));
        }

        [UnityTest]
        public IEnumerator ANearColliderThatGetsASurfaceIsFeltInTheNextFrame()
        {
            GameObject cube = Cube();
            yield return Frames(2);
            Assert.That(stylus.IsTouching, Is.False);
            var surface = cube.AddComponent<HapticSurface>();
            yield return null;
            Assert.That(Touched(), Is.SameAs(surface));
        }

        // Unity reports a move of direct children only.
        [UnityTest]
        public IEnumerator ANearColliderMovedDeepBelowASurfaceIsFeltWithinThirtyFrames()
        {
            GameObject child = Make("child");
            child.transform.SetParent(parent.transform, false);
            GameObject cube = Cube();
            yield return Frames(2);
            Assert.That(stylus.IsTouching, Is.False);
            cube.transform.SetParent(child.transform, true);
            for (int frame = 0; frame <= UntaggedColliders.Lookups; ++frame)
            {
                yield return null;
            }
            Assert.That(Touched(), Is.SameAs(parent));
        }

        [UnityTest]
        public IEnumerator ARemovedNestedSurfaceLeavesItsCollidersToTheSurfaceAbove()
        {
            GameObject cube = Cube();
            cube.transform.SetParent(parent.transform, false);
            var nested = cube.AddComponent<HapticSurface>();
            yield return Frames(2);
            Assert.That(Touched(), Is.SameAs(nested));
            Assert.That(parent.Colliders.Count, Is.EqualTo(1));
            Object.DestroyImmediate(nested);
            yield return null;
            Assert.That(Touched(), Is.SameAs(parent));
            Assert.That(parent.Colliders.Count, Is.EqualTo(2));
        }

        [UnityTest]
        public IEnumerator ANestedSurfaceThatIsSwitchedOffKeepsItsCollidersFromBeingFelt()
        {
            GameObject cube = Cube();
            cube.transform.SetParent(parent.transform, false);
            var nested = cube.AddComponent<HapticSurface>();
            yield return null;
            nested.enabled = false;
            yield return null;
            Assert.That(stylus.IsTouching, Is.False);
            nested.enabled = true;
            yield return null;
            Assert.That(Touched(), Is.SameAs(nested));
        }

        [UnityTest]
        public IEnumerator AColliderMovedBelowAnotherSurfaceBelongsToIt()
        {
            HapticSurface other = Tagged<SphereCollider>("fur", sphere => sphere.center = new Vector3(0f, 9f, 0f));
            GameObject cube = Cube();
            cube.transform.SetParent(parent.transform, false);
            yield return Frames(2);
            Assert.That(Touched(), Is.SameAs(parent));
            cube.transform.SetParent(other.transform, true);
            yield return null;
            Assert.That(Touched(), Is.SameAs(other));
        }

        [UnityTest]
        public IEnumerator IncludeChildrenAppliesAtOnce()
        {
            Cube().transform.SetParent(parent.transform, false);
            yield return null;
            parent.IncludeChildren = false;
            yield return null;
            Assert.That(stylus.IsTouching, Is.False);
            Assert.That(parent.Colliders.Count, Is.EqualTo(1));
            parent.IncludeChildren = true;
            yield return null;
            Assert.That(Touched(), Is.SameAs(parent));
        }

        private HapticSurface? Touched() => stylus.IsTouching ? stylus.Contact.Surface : null;

        private GameObject Cube()
        {
            GameObject cube = Make("cube");
            cube.AddComponent<BoxCollider>().size = new Vector3(0.1f, 0.1f, 0.1f);
            return cube;
        }
    }
}
