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
        [Test]
        public void ChangingASurfacesMaterialChangesNeitherTheAssetNorItsOtherUsers()
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
        }

        [Test]
        public void TheOwnCopyStartsEqualToTheSharedMaterial()
        {
            HapticMaterial shared = Shared();
            HapticSurface board = Board("fur");
            board.SharedMaterial = shared;
            MaterialDescription own = board.Material;
            Assert.That(own, Is.Not.SameAs(shared.Description));
            Assert.That((own.Label, own.SecondLabel, own.Blend, own.StiffnessNewtonsPerMetre),
                Is.EqualTo(("glass", "stone", 0.25f, 321f)));
            Assert.That((own.Strength, own.FeatureScale, own.ToneDbPerOctave), Is.EqualTo((0.5f, 2f, -3f)));
            Assert.That(board.Material, Is.SameAs(own), "a second read returns the same copy");
        }

        [Test]
        public void FeatureScaleAndToneAreLimitedToTheirRanges()
        {
            var material = new MaterialDescription();
            Assert.That((material.FeatureScale, material.ToneDbPerOctave), Is.EqualTo((1f, 0f)), "the default");
            (material.FeatureScale, material.ToneDbPerOctave) = (9f, 40f);
            Assert.That((material.FeatureScale, material.ToneDbPerOctave), Is.EqualTo((4f, 12f)));
            (material.FeatureScale, material.ToneDbPerOctave) = (0f, -40f);
            Assert.That((material.FeatureScale, material.ToneDbPerOctave), Is.EqualTo((0.25f, -12f)));
        }

        private HapticMaterial Shared() => Feeling("glass", material =>
        {
            (material.SecondLabel, material.Blend, material.StiffnessNewtonsPerMetre) = ("stone", 0.25f, 321f);
            (material.Strength, material.FeatureScale, material.ToneDbPerOctave) = (0.5f, 2f, -3f);
        });
    }

    /// <summary>The effects of a surface reach the voice, and no other effect runs.</summary>
    public sealed class SurfaceEffectsTests : SceneTest
    {
        private HapticSurface board = null!;

        [SetUp]
        public void MakeABoard()
        {
            FinishLoading();
            board = Board();
        }

        [UnityTest]
        public IEnumerator ASurfaceWithoutImpactsPlaysNone()
        {
            board.Material.Effects = HapticEffects.Texture;
            HapticStylus stylus = StylusAlong(
                seconds => new Vector3(0f, Mathf.Max(0.001f, 0.02f - 0.3f * (float)seconds), 0f));
            yield return Frames(12);
            Assert.That(stylus.IsTouching, Is.True);
            Assert.That(StatisticsOf(stylus, HapticEffect.Impact).IsAskedFor, Is.False);
            EffectStatistics edge = StatisticsOf(stylus, HapticEffect.Edge);
            Assert.That(edge.IsAskedFor, Is.False);
            Assert.That(edge.Runs + edge.Prepared + edge.Events, Is.Zero);
        }

        [UnityTest]
        public IEnumerator SlidingOffTheRimOfABoardPlaysOneEdge()
        {
            AudioTap tap = Output(out _);
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0.15f + 0.2f * (float)seconds, 0.001f, 0f));
            yield return Frames(40);
            Assert.That(stylus.IsTouching, Is.False);
            EffectStatistics edge = StatisticsOf(stylus, HapticEffect.Edge);
            Assert.That(edge.Events, Is.EqualTo(1UL));
            Assert.That(edge.Runs, Is.GreaterThan(0UL));
            Assert.That(tap.BrokenSamples, Is.Zero);
        }

        [UnityTest]
        public IEnumerator LiftingPlaysNoEdge()
        {
            Output(out _);
            HapticStylus stylus = StylusAlong(seconds =>
                new Vector3(0.1f * (float)seconds, seconds < 0.3 ? 0.001f : 0.001f + 0.5f * (float)(seconds - 0.3), 0f));
            yield return Frames(40);
            Assert.That(stylus.IsTouching, Is.False);
            Assert.That(StatisticsOf(stylus, HapticEffect.Edge).Events, Is.Zero);
        }

        [UnityTest]
        public IEnumerator SlidingAgainstAWallPlaysALandingWithinTheTouch()
        {
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
            Assert.That(StatisticsOf(stylus, HapticEffect.Impact).Events, Is.EqualTo(1UL),
                "the tip entered the board without speed");
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
                ContactState state = reading.State;
                Assert.That((state.HasPlace, state.SurfaceSeed), Is.EqualTo((true, 7u)));
                var place = new Vector3(state.PlaceMetres.X, state.PlaceMetres.Y, state.PlaceMetres.Z);
                Assert.That(Vector3.Distance(place, new Vector3(0.03f, 0f, 0.04f)), Is.LessThan(1e-5f));
                Assert.That(state.FirstAxis.X, Is.EqualTo(1f).Within(1e-5f));
                Assert.That(state.SecondAxis.Z, Is.EqualTo(-1f).Within(1e-5f));
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
            Cube(parent.transform);
            Assert.That(parent.Colliders.Count, Is.EqualTo(2));
            yield return Touches(parent);
        }

        [UnityTest]
        public IEnumerator AColliderAddedToAGrandchildIsFelt()
        {
            GameObject grandchild = Below(Below(parent.gameObject));
            yield return Touches(null, 2);
            grandchild.AddComponent<BoxCollider>().size = new Vector3(0.1f, 0.1f, 0.1f);
            yield return Touches(parent);
            Assert.That(parent.Colliders.Count, Is.EqualTo(2));
        }

        [UnityTest]
        public IEnumerator ANearColliderThatGetsASurfaceIsFeltInTheNextFrame()
        {
            GameObject cube = Cube();
            yield return Touches(null, 2);
            var surface = cube.AddComponent<HapticSurface>();
            yield return Touches(surface);
        }

        // Unity reports a move of direct children only.
        [UnityTest]
        public IEnumerator ANearColliderMovedDeepBelowASurfaceIsFeltWithinThirtyFrames()
        {
            GameObject child = Below(parent.gameObject);
            GameObject cube = Cube();
            yield return Touches(null, 2);
            cube.transform.SetParent(child.transform, true);
            yield return Touches(parent, UntaggedColliders.Lookups + 1);
        }

        [UnityTest]
        public IEnumerator ARemovedNestedSurfaceLeavesItsCollidersToTheSurfaceAbove()
        {
            GameObject cube = Cube(parent.transform);
            var nested = cube.AddComponent<HapticSurface>();
            yield return Touches(nested, 2);
            Assert.That(parent.Colliders.Count, Is.EqualTo(1));
            Object.DestroyImmediate(nested);
            yield return Touches(parent);
            Assert.That(parent.Colliders.Count, Is.EqualTo(2));
        }

        [UnityTest]
        public IEnumerator ANestedSurfaceThatIsSwitchedOffKeepsItsCollidersFromBeingFelt()
        {
            GameObject cube = Cube(parent.transform);
            var nested = cube.AddComponent<HapticSurface>();
            yield return null;
            nested.enabled = false;
            yield return Touches(null);
            nested.enabled = true;
            yield return Touches(nested);
        }

        [UnityTest]
        public IEnumerator AColliderMovedBelowAnotherSurfaceBelongsToIt()
        {
            HapticSurface other = Tagged<SphereCollider>("fur", sphere => sphere.center = new Vector3(0f, 9f, 0f));
            GameObject cube = Cube(parent.transform);
            yield return Touches(parent, 2);
            cube.transform.SetParent(other.transform, true);
            yield return Touches(other);
        }

        [UnityTest]
        public IEnumerator IncludeChildrenAppliesAtOnce()
        {
            Cube(parent.transform);
            yield return null;
            parent.IncludeChildren = false;
            yield return Touches(null);
            Assert.That(parent.Colliders.Count, Is.EqualTo(1));
            parent.IncludeChildren = true;
            yield return Touches(parent);
        }

        /// <summary>After some frames the tip touches a surface; null for none.</summary>
        private IEnumerator Touches(HapticSurface? surface, int afterFrames = 1)
        {
            yield return Frames(afterFrames);
            Assert.That(stylus.IsTouching, Is.EqualTo(surface != null));
            Assert.That(surface == null || stylus.Contact.Surface == surface, Is.True);
        }

        private GameObject Below(GameObject above)
        {
            GameObject child = Make("child");
            child.transform.SetParent(above.transform, false);
            return child;
        }

        private GameObject Cube(Transform? below = null)
        {
            GameObject cube = Make("cube");
            cube.AddComponent<BoxCollider>().size = new Vector3(0.1f, 0.1f, 0.1f);
            cube.transform.SetParent(below, false);
            return cube;
        }
    }
}
