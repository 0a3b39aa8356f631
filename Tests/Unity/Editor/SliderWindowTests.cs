#nullable enable
using System.IO;
using System.Linq;
using HaptoFlow.Editor;
using HaptoFlow.Model;
using HaptoFlow.Preview;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.PreviewTests
{
    /// <summary>Sliders and learnt materials in the Texture Preview.</summary>
    public sealed class SliderWindowTests : PreviewWindowTest
    {
        private const string Saved = "Assets/HaptoFlowSliderTests.asset";

        [TearDown]
        public void DeleteSaved() => AssetDatabase.DeleteAsset(Saved);

        private static string Text(string label) => MaterialText.OfLabel(DefaultFile(), label);

        private static float[] Moves(string name, float value)
        {
            SliderSet sliders = SliderCatalog.Of(ProjectSettingsAsset.DefaultModel()).Sliders!;
            return sliders.Sliders.Select(slider => slider.Name == name ? value : 0f).ToArray();
        }

        [Test]
        public void TheDefaultModelHasTheFiveDocumentedSliders() => Assert.That(
            SliderCatalog.Of(ProjectSettingsAsset.DefaultModel()).Sliders!.Sliders.Select(slider => slider.Name),
            Is.EqualTo(new[] { "coarseness", "hardness", "regularity", "stickiness", "level" }));

        [Test]
        public void AMaterialFileOfALabelSoundsLikeTheLabel()
        {
            HapticMaterial material = Keep(HapticMaterial.Create(Text("glass"), "fur"));
            TexturePreviewWindow.Open(material);
            Window.Finish();
            Assert.That(Window.Session!.Problem, Is.Null);
            Assert.That(Window.Player!.PlayedSound!.Sound.Title, Is.EqualTo("glass"));
            double learnt = Window.Player.PlayedSound.Sound.RmsMps2;
            State.Change("Label", changed => changed.First.Choose("glass"));
            Window.Finish();
            Assert.That(State.First.Learnt, Is.Null);
            Assert.That(Window.Player.PlayedSound!.Sound.RmsMps2, Is.EqualTo(learnt).Within(0.1 * learnt));
        }

        [Test]
        public void ADestroyedMaterialIsReplacedByItsLabel()
        {
            HapticMaterial material = HapticMaterial.Create(Text("glass"), "fur");
            TexturePreviewWindow.Open(material);
            Window.Finish();
            Object.DestroyImmediate(material);
            State.Change("Seed", changed => changed.Seed = 3);
            Window.Finish();
            Assert.That(Window.Session!.Problem, Is.Null);
            Assert.That(Window.Player!.PlayedSound!.Sound.Title, Is.EqualTo("fur"));
        }

        [Test]
        public void AMaterialOfAnotherModelIsReported()
        {
            string foreign = Text("glass").Replace(ModelHeader.Read(DefaultFile()).Space, "0badcafe");
            TexturePreviewWindow.Open(Keep(HapticMaterial.Create(foreign, "fur")));
            Window.Finish();
            Assert.That(Window.Session!.Problem, Does.Contain("0badcafe"));
        }

        [Test]
        public void ApplyingALearntMaterialToAnObjectCanBeUndone()
        {
            HapticMaterial material = Keep(HapticMaterial.Create(Text("glass"), "fur"));
            GameObject table = Make("Table");
            table.AddComponent<BoxCollider>();
            Undo.IncrementCurrentGroup();
            string message = SceneMaterial.Apply(new LabelMix("glass"), material, new Object[] { table });
            Assert.That(message, Is.EqualTo("Applied glass to Table"));
            MaterialDescription own = table.GetComponent<HapticSurface>().Material;
            Assert.That((own.Learnt, own.Label), Is.EqualTo((material, "fur")));
            Assert.That(SceneMaterial.TryRead(table, out _, out HapticMaterial? read), Is.True);
            Assert.That(read, Is.SameAs(material));
            Undo.PerformUndo();
            Assert.That(table.TryGetComponent(out HapticSurface _), Is.False);
        }

        [Test]
        public void AChangedMaterialMustBeSavedBeforeItIsApplied()
        {
            HapticSurface table = Make("Table").AddComponent<HapticSurface>();
            table.Material.Label = "stone";
            string message = SceneMaterial.Apply(
                new LabelMix("wood", "", 0f, "", new[] { 0.5f }), null, new Object[] { table.gameObject });
            Assert.That(message, Does.Contain("Save the changed material"));
            Assert.That(table.Material.Label, Is.EqualTo("stone"));
        }

        [Test]
        public void OverwritingASavedMaterialCanBeUndone()
        {
            SliderSet sliders = SliderCatalog.Of(ProjectSettingsAsset.DefaultModel()).Sliders!;
            using HapticModel model = HapticModel.Open(DefaultFile());
            string moved = new LabelMix("wood", "", 0f, "", Moves("hardness", 0.5f)).MaterialText(model, sliders);
            HapticMaterial asset = MaterialAssets.Save(Saved, moved, "wood");
            Assert.That(AssetDatabase.LoadAssetAtPath<HapticMaterial>(Saved), Is.SameAs(asset));
            Assert.That((asset.IsLearnt, asset.Description.Label), Is.EqualTo((true, "wood")));
            Assert.That(MaterialFile.Read(asset.Learnt).Name, Is.EqualTo("wood, moved"));
            Undo.IncrementCurrentGroup();
            MaterialAssets.Save(Saved, Text("glass"), "glass");
            Assert.That((asset.Learnt, asset.Description.Label), Is.EqualTo((Text("glass"), "glass")));
            Undo.PerformUndo();
            Assert.That((asset.Learnt, asset.Description.Label), Is.EqualTo((moved, "wood")));
        }

        [Test]
        public void AModelHasTheSlidersOfTheFileBesideItIfTheyAreForIt()
        {
            const string path = "Assets/HaptoFlowSliderTests.haptoflow";
            const string beside = "Assets/HaptoFlowSliderTests.sliders.json";
            string shipped = File.ReadAllText(FileUtil.GetPhysicalPath(SliderCatalog.DefaultPath));
            File.WriteAllBytes(path, DefaultFile());
            File.WriteAllText(beside, shipped.Replace(ModelHeader.Read(DefaultFile()).Space, "0badcafe"));
            try
            {
                AssetDatabase.ImportAsset(path);
                var model = AssetDatabase.LoadAssetAtPath<HapticModelAsset>(path);
                SliderCatalog.Forget();
                Assert.That(SliderCatalog.Of(model).Sliders, Is.Null);
                Assert.That(SliderCatalog.Of(model).Problem, Does.Contain("0badcafe").And.Contain(beside));
                File.WriteAllText(beside, shipped);
                SliderCatalog.Forget();
                Assert.That(SliderCatalog.Of(model).Sliders!.Sliders, Has.Count.EqualTo(5));
                File.WriteAllText(beside, "{}");
                SliderCatalog.Forget();
                Assert.That(SliderCatalog.Of(model).Problem, Does.Contain("cannot be read: the document has no key \"format\""));
            }
            finally
            {
                SliderCatalog.Forget();
                AssetDatabase.DeleteAsset(path);
                AssetDatabase.DeleteAsset(beside);
            }
        }
    }
}
