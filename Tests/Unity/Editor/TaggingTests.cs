#nullable enable
using System.Linq;
using HaptoFlow.Editor;
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
        public void ObjectsAreTaggedByTheirNames()
        {
            GameObject table = Box("Oak_Table");
            GameObject door = Box("Steel Door");
            GameObjectMenu.TagSelected(new[] { table, door }, Matcher);
            Assert.That(LabelOf(table), Is.EqualTo("wood"));
            Assert.That(LabelOf(door), Is.EqualTo("metal"));
        }

        [Test]
        public void OneUndoRemovesAllTags()
        {
            GameObject table = Box("Oak_Table");
            GameObject door = Box("Steel Door");
            Undo.IncrementCurrentGroup();
            GameObjectMenu.TagSelected(new[] { table, door }, Matcher);
            Undo.PerformUndo();
            Assert.That(table != null && door != null, Is.True);
            Assert.That(table!.TryGetComponent(out HapticSurface _), Is.False);
            Assert.That(door!.TryGetComponent(out HapticSurface _), Is.False);
        }

        [Test]
        public void TaggedObjectsAreNotChanged()
        {
            HapticSurface surface = Tagged("Oak_Table", "glass");
            GameObjectMenu.TagSelected(new[] { surface.gameObject }, Matcher);
            Assert.That(surface.Material.Label, Is.EqualTo("glass"));
        }

        [Test]
        public void AnObjectWithoutAProposalIsLeftUntaggedAndLogged()
        {
            GameObject thing = Box("Thing");
            TagPlan plan = Plan(thing);
            Assert.That(plan.Proposals, Is.Empty);
            Assert.That(plan.Unmatched, Is.EqualTo(new[] { thing }));
            GameObjectMenu.TagSelected(new[] { thing }, Matcher);
            Assert.That(thing.TryGetComponent(out HapticSurface _), Is.False);
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
        }

        [Test]
        public void CollidersThatCannotBeFeltAreNotTagged()
        {
            GameObject zone = Box("Wood Zone");
            zone.GetComponent<BoxCollider>().isTrigger = true;
            Make("Wooden Group");
            Assert.That(Plan(zone).Proposals, Is.Empty);
        }

        [Test]
        public void AStylusFromTheMenuHasATipAndCanBeUndone()
        {
            Undo.IncrementCurrentGroup();
            GameObject hand = Make("Hand");
            CreateMenu.CreateStylus(new MenuCommand(hand));
            HapticStylus stylus = Object.FindObjectsByType<HapticStylus>(
                FindObjectsInactive.Include, FindObjectsSortMode.None).Single();
            Assert.That(stylus.transform.parent, Is.EqualTo(hand.transform));
            Assert.That(stylus.Tip!.parent, Is.EqualTo(stylus.transform));
            Assert.That(Selection.activeObject, Is.EqualTo(stylus.gameObject));
            Undo.PerformUndo();
            Assert.That(Object.FindObjectsByType<HapticStylus>(
                FindObjectsInactive.Include, FindObjectsSortMode.None), Is.Empty);
        }

        private static TagPlan Plan(GameObject root) =>
            TagPlan.For(SceneColliders.Below(new[] { root }), new[] { root }, Matcher);

        private static string LabelOf(GameObject tagged) => tagged.GetComponent<HapticSurface>().Material.Label;
    }
}
