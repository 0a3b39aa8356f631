#nullable enable
using System.Collections;
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;

namespace HaptoFlow.Tests
{
    /// <summary>Own and shared materials behave like Renderer.material and Renderer.sharedMaterial.</summary>
    public sealed class SurfaceMaterialTests : SceneTest
    {
        [UnityTest]
        public IEnumerator ChangingASurfacesMaterialChangesNeitherTheAssetNorItsOtherUsers()
        {
            FinishLoading();
            HapticMaterial shared = Shared();
            HapticSurface first = Board();
            HapticSurface second = Board();
            first.SharedMaterial = shared;
            second.SharedMaterial = shared;
            LabelBlend glass = second.LookUp(HapticSession.Current).Labels;
            first.Material.Label = "rubber";
            Assert.That(shared.Description.Label, Is.EqualTo("glass"));
            Assert.That(second.LookUp(HapticSession.Current).Labels, Is.EqualTo(glass));
            Assert.That(first.LookUp(HapticSession.Current).Labels, Is.Not.EqualTo(glass));
            Assert.That(first.SharedMaterial, Is.Null);
            yield return null;
        }

        [UnityTest]
        public IEnumerator TheOwnCopyStartsEqualToTheSharedMaterial()
        {
            HapticMaterial shared = Shared();
            HapticSurface board = Board("fur");
            board.SharedMaterial = shared;
            MaterialDescription own = board.Material;
            Assert.That(own, Is.Not.SameAs(shared.Description));
            Assert.That(own.Label, Is.EqualTo("glass"));
            Assert.That(own.SecondLabel, Is.EqualTo("stone"));
            Assert.That(own.Blend, Is.EqualTo(0.25f));
            Assert.That(own.StiffnessNewtonsPerMetre, Is.EqualTo(321f));
            Assert.That(own.Strength, Is.EqualTo(0.5f));
            Assert.That(own.FeatureScale, Is.EqualTo(2f));
            Assert.That(own.ToneDbPerOctave, Is.EqualTo(-3f));
            Assert.That(board.Material, Is.SameAs(own), "a second read returns the same copy");
            yield return null;
        }

        [UnityTest]
        public IEnumerator FeatureScaleAndToneAreLimitedToTheirRanges()
        {
            var material = new MaterialDescription();
            Assert.That(material.FeatureScale, Is.EqualTo(1f), "the default leaves features unchanged");
            Assert.That(material.ToneDbPerOctave, Is.Zero, "no tilt");
            material.FeatureScale = 9f;
            material.ToneDbPerOctave = 40f;
            Assert.That(material.FeatureScale, Is.EqualTo(4f));
            Assert.That(material.ToneDbPerOctave, Is.EqualTo(12f));
            material.FeatureScale = 0f;
            material.ToneDbPerOctave = -40f;
            Assert.That(material.FeatureScale, Is.EqualTo(0.25f));
            Assert.That(material.ToneDbPerOctave, Is.EqualTo(-12f));
            yield return null;
        }

        private static HapticMaterial Shared()
        {
            var shared = ScriptableObject.CreateInstance<HapticMaterial>();
            shared.Description.Label = "glass";
            shared.Description.SecondLabel = "stone";
            shared.Description.Blend = 0.25f;
            shared.Description.StiffnessNewtonsPerMetre = 321f;
            shared.Description.Strength = 0.5f;
            shared.Description.FeatureScale = 2f;
            shared.Description.ToneDbPerOctave = -3f;
            return shared;
        }
    }

    /// <summary>The effects of a surface reach the voice, and no other effect runs.</summary>
    public sealed class SurfaceEffectsTests : SceneTest
    {
        [UnityTest]
        public IEnumerator ASurfaceWithoutImpactsPlaysNone()
        {
            FinishLoading();
            HapticSurface board = Board();
            board.Material.Effects = HapticEffects.Texture;
            HapticStylus stylus = StylusAlong(
                seconds => new Vector3(0f, Mathf.Max(0.001f, 0.02f - 0.3f * (float)seconds), 0f));
            yield return Frames(12);
            Assert.That(stylus.IsTouching, Is.True);
            Assert.That(stylus.TryGetEffectStatistics(HapticEffect.Impact, out EffectStatistics impact), Is.True);
            Assert.That(impact.IsAskedFor, Is.False);
            Assert.That(stylus.TryGetEffectStatistics(HapticEffect.Edge, out EffectStatistics edge), Is.True);
            Assert.That(edge.IsAskedFor, Is.False);
            Assert.That(edge.Runs + edge.Prepared + edge.Events, Is.Zero);
        }

        [UnityTest]
        public IEnumerator SlidingOffTheRimOfABoardPlaysOneEdge()
        {
            FinishLoading();
            Board();
            AudioTap tap = Output(out _);
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0.15f + 0.2f * (float)seconds, 0.001f, 0f));
            yield return Frames(40);
            Assert.That(stylus.IsTouching, Is.False);
            Assert.That(stylus.TryGetEffectStatistics(HapticEffect.Edge, out EffectStatistics edge), Is.True);
            Assert.That(edge.Events, Is.EqualTo(1UL));
            Assert.That(edge.Runs, Is.GreaterThan(0UL));
            Assert.That(tap.BrokenSamples, Is.Zero);
        }

        [UnityTest]
        public IEnumerator LiftingPlaysNoEdge()
        {
            FinishLoading();
            Board();
            Output(out _);
            HapticStylus stylus = StylusAlong(seconds =>
                new Vector3(0.1f * (float)seconds, seconds < 0.3 ? 0.001f : 0.001f + 0.5f * (float)(seconds - 0.3), 0f));
            yield return Frames(40);
            Assert.That(stylus.IsTouching, Is.False);
            Assert.That(stylus.TryGetEffectStatistics(HapticEffect.Edge, out EffectStatistics edge), Is.True);
            Assert.That(edge.Events, Is.Zero);
        }

        [UnityTest]
        public IEnumerator SlidingAgainstAWallPlaysALandingWithinTheTouch()
        {
            FinishLoading();
            Board();
            HapticSurface wall = Tagged<BoxCollider>("stone", box =>
            {
                box.size = new Vector3(0.1f, 0.2f, 0.4f);
                box.center = new Vector3(0.1f, 0.1f, 0f);
            });
            wall.Material.Effects = HapticEffects.Impact;
            Output(out _);
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0.01f + 0.2f * (float)seconds, 0.001f, 0f));
            yield return Frames(40);
            Assert.That(stylus.Contact.Surface, Is.SameAs(wall));
            Assert.That(stylus.Contact.TouchCounter, Is.EqualTo(1u));
            Assert.That(stylus.Contact.ApproachSpeedMps, Is.EqualTo(0.2f).Within(0.02f));
            Assert.That(stylus.TryGetEffectStatistics(HapticEffect.Impact, out EffectStatistics impact), Is.True);
            Assert.That(impact.Events, Is.EqualTo(1UL), "the tip entered the board without speed");
        }

        [Test]
        public void AMaterialHasAllEffectsByDefault()
        {
            var description = new MaterialDescription();
            Assert.That(
                description.Effects, Is.EqualTo(HapticEffects.Texture | HapticEffects.Impact | HapticEffects.Edge));
            description.Effects = HapticEffects.Nothing;
            Assert.That(description.Effects, Is.EqualTo(HapticEffects.Nothing));
            description.Effects = HapticEffects.Edge;
            Assert.That(description.Effects, Is.EqualTo(HapticEffects.Edge));
            var copy = new MaterialDescription();
            copy.CopyFrom(description);
            Assert.That(copy.Effects, Is.EqualTo(HapticEffects.Edge));
        }
    }

    public sealed class SurfaceSeedTests : SceneTest
    {
        [Test]
        public void TwoObjectsOfOneLabelDiffer() => Assert.That(Of(Board()), Is.Not.EqualTo(Of(Board())));

        [Test]
        public void AnObjectWithASeedKeepsItWhereverItIs()
        {
            HapticSurface board = Board();
            board.Seed = 7;
            board.transform.SetParent(Make("room").transform, false);
            Assert.That(Of(board), Is.EqualTo(7u));
        }

        [Test]
        public void CollidersOfOneSurfaceDifferUnlessTheyShareAnObject([Values(0u, 7u)] uint seed)
        {
            HapticSurface board = Board();
            board.Seed = seed;
            Collider own = board.GetComponent<BoxCollider>();
            Collider beside = board.gameObject.AddComponent<SphereCollider>();
            Collider first = Part(board.gameObject);
            Collider second = Part(board.gameObject);
            Collider below = Part(first.gameObject);
            Assert.That(SurfaceSeeds.Of(beside, board), Is.EqualTo(SurfaceSeeds.Of(own, board)));
            Assert.That(new[] { own, first, second, below }, Is.Unique.Using<Collider>((left, right) =>
                SurfaceSeeds.Of(left, board) == SurfaceSeeds.Of(right, board)));
        }

        [Test]
        public void ThePlaceInTheHierarchyGivesTheSameNumberAfterAReload()
        {
            uint[] Load()
            {
                GameObject room = Make("room");
                uint[] numbers = { SurfaceSeeds.Of(Part(room), null), SurfaceSeeds.Of(Part(room), null) };
                Object.DestroyImmediate(room);
                return numbers;
            }
            uint[] before = Load();
            Assert.That(Load(), Is.EqualTo(before));
            Assert.That(before[0], Is.Not.EqualTo(before[1]));
        }

        [UnityTest]
        public IEnumerator AContactNamesItsSurfaceAndThePlaceOnItWhereverTheObjectIs()
        {
            HapticSurface board = Board();
            board.Seed = 7;
            var contacts = new TipContacts(0.002, Make("Stylus").transform);
            yield return null;
            ContactReading before = Touch(contacts, board, 1.0);
            board.transform.position = new Vector3(0.4f, 0.2f, -0.1f);
            board.transform.rotation = Quaternion.AngleAxis(50f, new Vector3(0.6f, 0f, 0.8f));
            yield return null;
            ContactReading after = Touch(contacts, board, 2.0);
            foreach (ContactReading reading in new[] { before, after })
            {
                Assert.That(reading.State.HasPlace, Is.True);
                Assert.That(reading.State.SurfaceSeed, Is.EqualTo(7u));
                Assert.That(reading.State.PlaceMetres.X, Is.EqualTo(0.03f).Within(1e-5f));
                Assert.That(reading.State.PlaceMetres.Y, Is.EqualTo(0f).Within(1e-5f));
                Assert.That(reading.State.PlaceMetres.Z, Is.EqualTo(0.04f).Within(1e-5f));
                Assert.That(reading.State.FirstAxis.X, Is.EqualTo(1f).Within(1e-5f));
                Assert.That(reading.State.SecondAxis.Z, Is.EqualTo(-1f).Within(1e-5f));
            }
            var lost = new TipSample(3.0, new Double3(double.NaN, 0.0, 0.0), null);
            ContactReading none = contacts.Update(lost, 3.0, -1, HapticSession.Current, board);
            Assert.That(none.State.HasPlace, Is.False);
        }

        private static ContactReading Touch(TipContacts contacts, HapticSurface board, double seconds)
        {
            Vector3 tip = board.transform.TransformPoint(new Vector3(0.03f, 0.001f, 0.04f));
            return contacts.Update(new TipSample(seconds, tip.ToDouble(), null), seconds, -1, HapticSession.Current, board);
        }

        private static uint Of(HapticSurface surface) => SurfaceSeeds.Of(surface.GetComponent<BoxCollider>(), surface);

        private Collider Part(GameObject parent)
        {
            GameObject part = Make("part");
            part.transform.SetParent(parent.transform, false);
            return part.AddComponent<BoxCollider>();
        }
    }

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
