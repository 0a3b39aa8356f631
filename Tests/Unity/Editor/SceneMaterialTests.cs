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
    /// <summary>Copies materials from the preview to the scene and back.</summary>
    public sealed class SceneMaterialTests : PreviewWindowTest
    {
        private static readonly LabelMix Mix = new LabelMix("rubber", "jute", 0.25f);

        [Test]
        public void ApplyingAMaterialKeepsStiffnessAndStrength()
        {
            HapticSurface table = Tagged("Table");
            table.Material.StiffnessNewtonsPerMetre = 700f;
            table.Material.Strength = 0.5f;
            SceneMaterial.Apply(Mix, null, new Object[] { table.gameObject });
            Assert.That(Read(table), Is.EqualTo(Mix));
            Assert.That(table.Material.StiffnessNewtonsPerMetre, Is.EqualTo(700f));
            Assert.That(table.Material.Strength, Is.EqualTo(0.5f));
        }

        [Test]
        public void AnObjectWithAColliderBecomesASurfaceAndOneWithoutIsReported()
        {
            GameObject box = Box("Box");
            GameObject light = Make("Light");
            string message = SceneMaterial.Apply(Mix, null, new Object[] { box, light });
            Assert.That(Read(box.GetComponent<HapticSurface>()), Is.EqualTo(Mix));
            Assert.That(light.TryGetComponent(out HapticSurface _), Is.False);
            Assert.That(message, Does.StartWith("Applied rubber 75 % + jute 25 % to Box; not to Light"));
            Assert.That(SceneMaterial.Apply(Mix, null, new Object[0]), Does.StartWith("Select objects of the scene"));
        }

        [Test]
        public void ApplyingToASelectionIsUndoneInOneStep()
        {
            HapticSurface table = Tagged("Table");
            table.Material.Label = "wood";
            GameObject box = Box("Box");
            HapticMaterial asset = Feeling("leather");
            Undo.IncrementCurrentGroup();
            SceneMaterial.Apply(Mix, null, new Object[] { table.gameObject, box, asset });
            Assert.That(asset.Description.Label, Is.EqualTo("rubber"));
            Undo.PerformUndo();
            Assert.That(Read(table), Is.EqualTo(new LabelMix("wood")));
            Assert.That(box.TryGetComponent(out HapticSurface _), Is.False);
            Assert.That(asset.Description.Label, Is.EqualTo("leather"));
        }

        [Test]
        public void ApplyingToASurfaceDoesNotChangeItsSharedAsset()
        {
            HapticMaterial asset = Feeling("leather");
            HapticSurface first = Tagged("First");
            HapticSurface second = Tagged("Second");
            (first.SharedMaterial, second.SharedMaterial) = (asset, asset);
            SceneMaterial.Apply(Mix, null, new Object[] { first.gameObject });
            Assert.That(Read(first), Is.EqualTo(Mix));
            Assert.That(Read(second), Is.EqualTo(new LabelMix("leather")));
            Assert.That(asset.Description.Label, Is.EqualTo("leather"));
        }

        [Test]
        public void FeatureScaleAndToneAreCopiedFromOneSurfaceToAnother()
        {
            HapticSurface table = Tagged("Table");
            table.Material.Label = "corduroy";
            table.Material.FeatureScale = 2f;
            table.Material.ToneDbPerOctave = 3f;
            TexturePreviewWindow.Open(table);
            Window.Finish();
            Assert.That(Window.Player!.PlayedSound!.Sound.Title, Is.EqualTo("corduroy (x2, +3 dB/oct)"));
            HapticSurface shelf = Tagged("Shelf");
            string message = SceneMaterial.Apply(
                Window.Player.PlayedSound.Sound.Material, null, new Object[] { shelf.gameObject });
            Assert.That(message, Is.EqualTo("Applied corduroy (x2, +3 dB/oct) to Shelf"));
            Assert.That((shelf.Material.FeatureScale, shelf.Material.ToneDbPerOctave), Is.EqualTo((2f, 3f)));
            Assert.That(Read(shelf), Is.EqualTo(Read(table)));
        }

        [Test]
        public void AChildHasTheMaterialOfItsParentsSurface()
        {
            HapticSurface table = Tagged("Table");
            table.Material.Label = "stone";
            GameObject leg = Make("Leg");
            leg.transform.SetParent(table.transform, false);
            Assert.That(SceneMaterial.TryRead(leg, out LabelMix mix, out _), Is.True);
            Assert.That(mix, Is.EqualTo(new LabelMix("stone")));
            Assert.That(SceneMaterial.TryRead(Make("Lamp"), out _, out _), Is.False);
            Assert.That(SceneMaterial.TryRead(null, out _, out _), Is.False);
        }

        private static LabelMix Read(HapticSurface surface)
        {
            Assert.That(SceneMaterial.TryRead(surface, out LabelMix mix, out _), Is.True);
            return mix;
        }
    }

    /// <summary>The button "Take from Selection": its material and its message.</summary>
    public sealed class TakeFromSelectionTests : PreviewWindowTest
    {
        private HapticMaterialMap map = null!;

        [SetUp]
        public void AddAMapToTheScene()
        {
            map = Keep(ScriptableObject.CreateInstance<HapticMaterialMap>());
            map.name = "Rooms";
            map.Add(HapticMaterialRule.ForTag("Finish", Feeling("stone")));
            map.Add(HapticMaterialRule.ForName("Ghost*", null));
            Make("Scope").AddComponent<HapticMaterialMapScope>().Map = map;
            Window.Finish();
        }

        [Test]
        public void TheMaterialOfARuleIsTakenAndTheRuleIsNamed()
        {
            map.Rules[0].Material!.Description.FeatureScale = 2f;
            map.Rules[0].Material!.Description.ToneDbPerOctave = -3f;
            GameObject step = Box("Step");
            step.tag = "Finish";
            Undo.IncrementCurrentGroup();
            Assert.That(Take(step), Is.EqualTo(
                "Took stone (x2, -3 dB/oct) from Step (rule 1 of \"Rooms\": tag \"Finish\")"));
            Assert.That(Played, Is.EqualTo(("stone", 2f, -3f)));
            Undo.PerformUndo();
            Assert.That(Played, Is.EqualTo(("wood", 1f, 0f)));
        }

        [Test]
        public void TheFirstPartWithAMaterialIsTakenAndNamed()
        {
            var mesh = Keep(new Mesh
            {
                vertices = new[]
                {
                    new Vector3(-0.1f, 0f, -0.1f), new Vector3(-0.1f, 0f, 0.1f), new Vector3(0f, 0f, -0.1f),
                    new Vector3(0f, 0f, 0.1f), new Vector3(0.1f, 0f, -0.1f), new Vector3(0.1f, 0f, 0.1f),
                },
                subMeshCount = 3,
            });
            mesh.SetTriangles(new[] { 0, 1, 3 }, 0);
            mesh.SetTriangles(new[] { 0, 3, 2 }, 1);
            mesh.SetTriangles(new[] { 2, 3, 5, 2, 5, 4 }, 2);
            map.Add(HapticMaterialRule.ForSubmesh(mesh, 1, Feeling("cork")));
            map.Add(HapticMaterialRule.ForSubmesh(mesh, 2, Feeling("glass")));
            GameObject tray = Make("Tray");
            tray.AddComponent<MeshCollider>().sharedMesh = mesh;
            Assert.That(Take(tray), Does.StartWith("Took cork from Tray (submesh 2 of 3; rule 3 of \"Rooms\""));
            map.Insert(0, HapticMaterialRule.ForName("Tray", Feeling("fur")));
            Assert.That(Take(tray), Does.StartWith("Took fur from Tray (rule 1"), "one rule applies to all parts");
        }

        [Test]
        public void TheMaterialOfAChildColliderIsTakenAndTheChildIsNamed()
        {
            GameObject house = Make("House");
            GameObject step = Box("Step");
            step.tag = "Finish";
            step.transform.SetParent(house.transform, false);
            Box("Attic").transform.SetParent(house.transform, false);
            Assert.That(Take(house), Is.EqualTo(
                "Took stone from House (Step; rule 1 of \"Rooms\": tag \"Finish\")"));
        }

        [Test]
        public void AnEnabledSurfaceTakesPrecedenceOverTheRules()
        {
            GameObject table = Box("Table");
            table.tag = "Finish";
            HapticSurface surface = table.AddComponent<HapticSurface>();
            surface.Material.Label = "cork";
            Assert.That(Take(table), Is.EqualTo("Took cork from Table"));
            surface.enabled = false;
            Assert.That(Take(table), Does.StartWith("Took stone from Table (rule 1"));
            table.tag = "Untagged";
            Assert.That(Take(table), Is.EqualTo("Took cork from Table (its Haptic Surface is disabled)"));
        }

        [Test]
        public void ARuleWithOnlyAMaskGivesTheFirstMaterialOfTheMask()
        {
            HapticMaskMap mask = Keep(ScriptableObject.CreateInstance<HapticMaskMap>());
            mask.name = "Paint";
            mask.Green.SetMaterial(Feeling("cork"));
            map.Rules[0].Mask = mask;
            GameObject step = Box("Step");
            step.tag = "Finish";
            Assert.That(Take(step), Is.EqualTo(
                "Took stone from Step (rule 1 of \"Rooms\": tag \"Finish\"; without its mask Paint)"));
            map.Rules[0].Material = null;
            Assert.That(Take(step), Is.EqualTo(
                "Took cork from Step (rule 1 of \"Rooms\": tag \"Finish\"; the first material of its mask Paint)"));
        }

        [Test]
        public void AnObjectWithoutMaterialIsReported()
        {
            GameObject door = Box("Door");
            door.GetComponent<Collider>().isTrigger = true;
            int version = State.Version;
            Assert.That(Take(Box("Ghost")), Is.EqualTo("Ghost has no haptic material (rule 2 of \"Rooms\": name \"Ghost*\")"));
            Assert.That(Take(Box("Lamp")), Is.EqualTo(
                "Lamp has no haptic material (it has no Haptic Surface, and no rule matches)"));
            Assert.That(Take(Make("Light")), Is.EqualTo("Light has no haptic material (it has no collider that can be touched)"));
            Assert.That(Take(door), Is.EqualTo("Door has no haptic material (it has no collider that can be touched)"));
            Assert.That(Take(null), Is.EqualTo("Select an object of the scene or a Haptic Material first"));
            Assert.That(Take(map), Is.EqualTo("Select an object of the scene or a Haptic Material first"));
            Assert.That(State.Version, Is.EqualTo(version));
        }

        private (string, float, float) Played =>
            (State.First.Label, State.First.FeatureScale, State.First.ToneDbPerOctave);

        private string Take(Object? selected) => SceneControls.TakeFrom(selected, State, Window.Session!.Model);
    }

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
            GameObject table = Box("Table");
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
