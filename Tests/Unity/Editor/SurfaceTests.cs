#nullable enable
using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.EditorTests
{
    public sealed class SurfaceListTests : EditorTest
    {
        [Test]
        public void OnlyCollidersBelowTheSelectionAreListed()
        {
            Box("Elsewhere");
            GameObject room = Make("Room");
            Box("Lamp", room);
            SurfaceList list = SurfaceList.Of(new[] { room });
            Assert.That(list.OfSelection, Is.True);
            Assert.That(list.NotFelt.Select(line => line.Text), Is.EqualTo(new[] { "Lamp" }));
            Assert.That(SurfaceList.Of(new[] { Make("Camera") }).OfSelection, Is.False, "without colliders, the scene");
        }

        [Test]
        public void CollidersOfChildrenBelongToASurfaceThatIncludesThem()
        {
            HapticSurface table = Tagged("Table", "wood");
            Collider leg = Box("Leg", table.gameObject).GetComponent<BoxCollider>();
            Assert.That(SceneColliders.SurfaceOf(leg), Is.EqualTo(table));
            table.IncludeChildren = false;
            Assert.That(SceneColliders.SurfaceOf(leg), Is.Null);
        }

        [Test]
        public void AColliderBelongsToTheNearestSurfaceAbove()
        {
            HapticSurface table = Tagged("Table", "wood");
            GameObject plate = Box("Plate", table.gameObject);
            var glass = plate.AddComponent<HapticSurface>();
            glass.Material.Label = "glass";
            glass.Material.SecondLabel = "nothing known";
            Assert.That(SurfaceList.Of(new[] { plate }).Felt.Single().Text,
                Is.EqualTo("Plate: glass and nothing known (not in model)"));
        }

        [Test]
        public void TriggersAndDisabledCollidersAreNotListed()
        {
            Box("Zone").GetComponent<BoxCollider>().isTrigger = true;
            Box("Off").GetComponent<BoxCollider>().enabled = false;
            SurfaceList list = SurfaceList.Of(new GameObject[0]);
            Assert.That(list.NotFelt, Is.Empty);
            Assert.That(list.Felt, Is.Empty);
        }
    }

    /// <summary>The reasons for a collider's material in edit mode, in the overlay and in the Inspector of a map.
    /// </summary>
    public sealed class MaterialReasonTests : EditorTest
    {
        private HapticMaterialMap map = null!;

        [SetUp]
        public void AddAMapToTheProject()
        {
            map = CreateMap();
            Settings().MaterialMap = map;
            ProjectSettingsAsset.Forget();
            map.Add(HapticMaterialRule.ForTag("Finish", Feeling("stone")));
            map.Add(HapticMaterialRule.ForName("Ghost*", null));
        }

        [Test]
        public void TheOverlayListsMaterialsAndRules()
        {
            Tagged("Table", "wood");
            Box("Step").tag = "Finish";
            Box("Ghost");
            Box("Lamp");
            SurfaceList list = SurfaceList.Of(new GameObject[0]);
            Assert.That(list.Felt.Select(line => line.Text), Is.EqualTo(new[]
            {
                "Step: stone (rule 1 of \"Rooms\": tag \"Finish\")", "Table: wood",
            }));
            Assert.That(list.NotFelt.Select(line => line.Text), Is.EqualTo(new[]
            {
                "Ghost (rule 2 of \"Rooms\": name \"Ghost*\")", "Lamp",
            }));
        }

        [Test]
        public void AScopeOfTheSceneTakesPrecedenceOverTheProjectsMap()
        {
            HapticMaterialMap ofScene = ScriptableObject.CreateInstance<HapticMaterialMap>();
            ofScene.name = "Cellar";
            ofScene.DefaultMaterial = Feeling("glass");
            HapticMaterialMapScope scope = Make("Scope").AddComponent<HapticMaterialMapScope>();
            scope.Map = ofScene;
            GameObject step = Box("Step");
            step.tag = "Finish";
            Assert.That(Line(step), Is.EqualTo("Step: glass (default of \"Cellar\")"));
            scope.enabled = false;
            Assert.That(Line(step), Is.EqualTo("Step: stone (rule 1 of \"Rooms\": tag \"Finish\")"));
        }

        [Test]
        public void AMapShowsWhatEachOfItsRulesMatches()
        {
            Box("Step").tag = "Finish";
            Assert.That(HapticMaterialMapEditor.LinesOf(map).Select(line => line.Text), Is.EqualTo(new[]
            {
                "Rule 1: tag \"Finish\" \u2192 stone: Step", "Rule 2: name \"Ghost*\" \u2192 nothing: no collider",
            }));
            HapticMaterialMap idle = ScriptableObject.CreateInstance<HapticMaterialMap>();
            Assert.That(HapticMaterialMapEditor.LinesOf(idle).Single().Text, Does.StartWith("This map is not in use"));
        }

        private static string Line(GameObject owner)
        {
            SurfaceList list = SurfaceList.Of(new[] { owner });
            return list.Felt.Concat(list.NotFelt).Single().Text;
        }
    }

    public sealed class SurfaceSeedKeeperTests : EditorTest
    {
        [Test]
        public void AComponentAddedInTheEditorHasASeedOfItsOwn()
        {
            uint first = Tagged("Table", "wood").Seed;
            Assert.That(first, Is.Not.Zero);
            Assert.That(Tagged("Table", "wood").Seed, Is.Not.EqualTo(first));
        }

        [Test]
        public void ACopyGetsASeedOfItsOwnAndTheOriginalKeepsIts()
        {
            HapticSurface original = Tagged("Table", "wood");
            uint seed = original.Seed;
            SurfaceSeedKeeper.Renew();
            HapticSurface copy = Tagged("Table", "wood");
            copy.Seed = seed;
            Undo.IncrementCurrentGroup();
            SurfaceSeedKeeper.Renew();
            Assert.That(original.Seed, Is.EqualTo(seed));
            Assert.That(copy.Seed, Is.Not.EqualTo(seed).And.Not.Zero);
            Undo.PerformUndo();
            Assert.That(copy.Seed, Is.EqualTo(seed));
        }

        [Test]
        public void TheSurfaceThatHadTheSeedKeepsItEvenIfTheOtherIsOlder()
        {
            HapticSurface older = Tagged("Chair", "wood");
            HapticSurface original = Tagged("Table", "wood");
            uint seed = original.Seed;
            SurfaceSeedKeeper.Renew();
            older.Seed = seed;
            SurfaceSeedKeeper.Renew();
            Assert.That(original.Seed, Is.EqualTo(seed));
            Assert.That(older.Seed, Is.Not.EqualTo(seed));
        }

        [Test]
        public void SurfacesWithoutASeedStayWithoutOne()
        {
            HapticSurface first = Tagged("Table", "wood");
            HapticSurface second = Tagged("Table", "wood");
            (first.Seed, second.Seed) = (0u, 0u);
            SurfaceSeedKeeper.Renew();
            Assert.That((first.Seed, second.Seed), Is.EqualTo((0u, 0u)));
        }
    }
}
