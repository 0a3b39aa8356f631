#nullable enable
using System.Linq;
using HaptoFlow.Editor;
using HaptoFlow.Model;
using NUnit.Framework;

namespace HaptoFlow.EditorTests
{
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
}
