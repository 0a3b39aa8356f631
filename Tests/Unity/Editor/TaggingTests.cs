#nullable enable
using System.Linq;
using HaptoFlow.Editor;
using HaptoFlow.Model;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
#if UNITY_6000_0_OR_NEWER
using PhysicMaterial = UnityEngine.PhysicsMaterial;
#endif

namespace HaptoFlow.EditorTests
{
    public sealed class TaggingTests : EditorTest
    {
        private static LabelMatcher Matcher => new LabelMatcher(LabelCatalog.Current.Names);

        [Test]
        public void ObjectsAreTaggedByTheirNamesAndOneUndoRemovesAllTags()
        {
            GameObject table = Box("Oak_Table");
            GameObject door = Box("Steel Door");
            Undo.IncrementCurrentGroup();
            GameObjectMenu.TagSelected(new[] { table, door }, Matcher);
            Assert.That((LabelOf(table), LabelOf(door)), Is.EqualTo(("wood", "metal")));
            Undo.PerformUndo();
            Assert.That(table != null && door != null, Is.True);
            Assert.That(table!.TryGetComponent(out HapticSurface _), Is.False);
            Assert.That(door!.TryGetComponent(out HapticSurface _), Is.False);
        }

        [Test]
        public void APhysicsMaterialTakesPrecedenceOverTheName()
        {
            GameObject table = Box("Oak_Table");
            table.GetComponent<BoxCollider>().sharedMaterial = new PhysicMaterial("Rubber Foam");
            TagProposal proposal = Plan(table).Proposals.Single();
            Assert.That(proposal.Label, Is.EqualTo("rubber"));
            Assert.That(proposal.Reason, Does.Contain("Rubber Foam"));
        }

        [Test]
        public void PartsWithAMeaninglessNameAreTaggedByTheirParent()
        {
            GameObject table = Make("Oak_Table");
            Box("Leg 1", table);
            Box("Leg 2", table);
            GameObject plate = Box("Glass Plate", table);
            TagPlan plan = Plan(table);
            Assert.That(plan.Proposals.Select(each => (each.Owner, each.Label)),
                Is.EquivalentTo(new[] { (table, "wood"), (plate, "glass") }));
            Assert.That(plan.Unmatched, Is.Empty);
            GameObjectMenu.TagSelected(new[] { table }, Matcher);
            Assert.That(Plan(table).Proposals, Is.Empty, "everything is tagged");
        }

        [Test]
        public void NamesAboveTheSelectionAreNotCompared()
        {
            GameObject house = Make("Wooden House");
            GameObject thing = Box("Thing", house);
            Assert.That(Plan(thing).Unmatched, Is.EqualTo(new[] { thing }));
            GameObjectMenu.TagSelected(new[] { thing }, Matcher);
            Assert.That(thing.TryGetComponent(out HapticSurface _), Is.False);
        }

        private static TagPlan Plan(GameObject root) =>
            TagPlan.For(SceneColliders.Below(new[] { root }), new[] { root }, Matcher);

        private static string LabelOf(GameObject tagged) => tagged.GetComponent<HapticSurface>().Material.Label;
    }

    public sealed class LabelMatcherTests
    {
        private static readonly LabelNames Names = new LabelNames(new[]
        {
            "wood", "plywood", "stone", "concrete", "brick", "ceramic", "glass", "metal", "metal mesh", "plastic",
            "rubber", "leather", "cotton", "corduroy", "jute", "fur", "paper", "cardboard", "sandpaper", "carpet",
        });

        [TestCase("Oak_Table", "wood")]
        [TestCase("WOOD_FLOOR", "wood")]
        [TestCase("SM_Door_Steel_01", "metal")]
        [TestCase("MetalMeshFence", "metal mesh")]
        [TestCase("Metal_Door", "metal")]
        [TestCase("WallBricks", "brick")]
        [TestCase("PVCPipe", "plastic")]
        [TestCase("Bottle_Plastic_Steel", "plastic")]
        [TestCase("MDF shelf", "plywood")]
        [TestCase("Tyres", "rubber")]
        public void ANameSuggestsALabel(string name, string label) =>
            Assert.That(new LabelMatcher(Names).Propose(name), Is.EqualTo(label));

        [TestCase("Mesh_Collider")]
        [TestCase("Player Mat")]
        [TestCase("Woodpecker")]
        [TestCase("")]
        public void AMeaninglessNameSuggestsNoLabel(string name) =>
            Assert.That(new LabelMatcher(Names).Propose(name), Is.Null);

        [Test]
        public void TheNameOfALabelTakesPrecedenceOverASynonymOfAnother() =>
            Assert.That(new LabelMatcher(Names).Propose("Oak_Imitation_Plastic"), Is.EqualTo("plastic"));

        [Test]
        public void OnlyLabelsOfTheModelAreProposed()
        {
            var few = new LabelMatcher(new LabelNames(new[] { "Wood", "stone" }));
            Assert.That(few.Propose("Oak"), Is.EqualTo("Wood"), "as the model writes it");
            Assert.That(few.Propose("MDF"), Is.EqualTo("Wood"), "the next best");
            Assert.That(few.Propose("Cement"), Is.EqualTo("stone"));
            Assert.That(few.Propose("Steel"), Is.Null);
            Assert.That(new LabelMatcher(new LabelNames(new string[0])).Propose("wood"), Is.Null);
        }

        [Test]
        public void EverySynonymStandsForALabelOfTheDefaultModel()
        {
            string[] strangers = LabelWords.All.Values.SelectMany(labels => labels).Distinct()
                .Where(label => !Names.TryFind(label, out _)).ToArray();
            Assert.That(strangers, Is.Empty);
            string[] shadowed = LabelWords.All.Keys.Where(word => Names.TryFind(word, out _)).ToArray();
            Assert.That(shadowed, Is.Empty, "the name of a label is no synonym for another one");
        }
    }

    public sealed class LabelOptionsTests : EditorTest
    {
        [Test]
        public void AllLabelsOfTheModelAreListedByName()
        {
            string[] offered = Texts("wood", false);
            Assert.That(offered, Has.Length.EqualTo(20).And.Ordered);
        }

        [Test]
        public void AnUnknownNameIsListedFirstFollowedBySimilarLabels()
        {
            string[] offered = Texts("plywod", false);
            Assert.That(offered[0], Is.EqualTo("plywod (not in model)"));
            Assert.That(offered[1], Is.EqualTo("plywood (near \"plywod\")"));
            Assert.That(offered, Has.Length.EqualTo(22));
            LabelOption first = LabelOptions.For(LabelCatalog.Current, "plywod", false)[0];
            Assert.That(first.Label, Is.EqualTo("plywod"));
        }

        [Test]
        public void NoneIsListedOnlyWhenTheLabelIsOptional()
        {
            Assert.That(LabelOptions.For(LabelCatalog.Current, "wood", true)[0].Label, Is.Empty);
            Assert.That(Texts("wood", true)[0], Is.EqualTo("none"));
            Assert.That(Texts("wood", false), Has.None.EqualTo("none"));
        }

        [Test]
        public void TheLabelsAreThoseOfTheProjectsModel()
        {
            HaptoFlowSettings settings = Settings();
            LabelCatalog before = LabelCatalog.Current;
            Assert.That(LabelCatalog.Current, Is.SameAs(before), "read once");
            settings.Model = HapticModelAsset.Create(ModelBytes.WithFigures(Model().File, "{}", "{}"));
            Assert.That(LabelCatalog.Current, Is.Not.SameAs(before));
            Assert.That(LabelCatalog.Current.Names.All, Has.Count.EqualTo(20));
        }

        [Test]
        public void WithoutAUsableModelNoNameIsUnknown()
        {
            Settings().Model = HapticModelAsset.Create(ModelBytes.Truncated(Model().File, 5000));
            Assert.That(LabelCatalog.Current.Names.All, Is.Empty);
            Assert.That(LabelCatalog.Current.IsUnknown("wood"), Is.False);
            Assert.That(LabelCatalog.Current.TextOf("wood"), Is.EqualTo("wood"));
        }

        [Test]
        public void LabelsAreComparedWithoutCase()
        {
            Assert.That(LabelCatalog.Current.IsUnknown("Wood"), Is.False);
            Assert.That(LabelCatalog.Current.StiffnessRemark("Wood"), Is.EqualTo("0: the model's 1200"));
            Assert.That(LabelCatalog.Current.StiffnessRemark("wodo"), Is.Empty);
        }

        private static string[] Texts(string present, bool canBeEmpty) =>
            LabelOptions.For(LabelCatalog.Current, present, canBeEmpty).Select(option => option.Text).ToArray();
    }
}
