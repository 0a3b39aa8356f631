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

        private static TagPlan Plan(GameObject root) =>
            TagPlan.For(SceneColliders.Below(new[] { root }), new[] { root }, Matcher);

        private static string LabelOf(GameObject tagged) => tagged.GetComponent<HapticSurface>().Material.Label;
    }
}
