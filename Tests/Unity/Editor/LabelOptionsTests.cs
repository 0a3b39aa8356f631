#nullable enable
using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;

namespace HaptoFlow.EditorTests
{
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
