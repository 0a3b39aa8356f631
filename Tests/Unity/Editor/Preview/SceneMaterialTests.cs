#nullable enable
using HaptoFlow.Editor;
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
            HapticSurface table = Surface("Table");
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
            GameObject box = Make("Box");
            box.AddComponent<BoxCollider>();
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
            HapticSurface table = Surface("Table");
            table.Material.Label = "wood";
            GameObject box = Make("Box");
            box.AddComponent<BoxCollider>();
            HapticMaterial asset = Asset("leather");
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
            HapticMaterial asset = Asset("leather");
            HapticSurface first = Surface("First");
            HapticSurface second = Surface("Second");
            foreach (HapticSurface each in new[] { first, second })
            {
                Share(each, asset);
            }
            SceneMaterial.Apply(Mix, null, new Object[] { first.gameObject });
            Assert.That(Read(first), Is.EqualTo(Mix));
            Assert.That(Read(second), Is.EqualTo(new LabelMix("leather")));
            Assert.That(asset.Description.Label, Is.EqualTo("leather"));
        }

        [Test]
        public void FeatureScaleAndToneAreCopiedFromOneSurfaceToAnother()
        {
            HapticSurface table = Surface("Table");
            table.Material.Label = "corduroy";
            table.Material.FeatureScale = 2f;
            table.Material.ToneDbPerOctave = 3f;
            TexturePreviewWindow.Open(table);
            Window.Finish();
            Assert.That(Window.Player!.PlayedSound!.Sound.Title, Is.EqualTo("corduroy (x2, +3 dB/oct)"));
            HapticSurface shelf = Surface("Shelf");
            string message = SceneMaterial.Apply(
                Window.Player.PlayedSound.Sound.Material, null, new Object[] { shelf.gameObject });
            Assert.That(message, Is.EqualTo("Applied corduroy (x2, +3 dB/oct) to Shelf"));
            Assert.That((shelf.Material.FeatureScale, shelf.Material.ToneDbPerOctave), Is.EqualTo((2f, 3f)));
            Assert.That(Read(shelf), Is.EqualTo(Read(table)));
        }

        [Test]
        public void AChildHasTheMaterialOfItsParentsSurface()
        {
            HapticSurface table = Surface("Table");
            table.Material.Label = "stone";
            GameObject leg = Make("Leg");
            leg.transform.SetParent(table.transform, false);
            Assert.That(SceneMaterial.TryRead(leg, out LabelMix mix, out _), Is.True);
            Assert.That(mix, Is.EqualTo(new LabelMix("stone")));
            Assert.That(SceneMaterial.TryRead(Make("Lamp"), out _, out _), Is.False);
            Assert.That(SceneMaterial.TryRead(null, out _, out _), Is.False);
        }

        private HapticSurface Surface(string name)
        {
            GameObject owner = Make(name);
            owner.AddComponent<BoxCollider>();
            return owner.AddComponent<HapticSurface>();
        }

        private HapticMaterial Asset(string label)
        {
            HapticMaterial asset = Keep(ScriptableObject.CreateInstance<HapticMaterial>());
            asset.name = label + " asset";
            asset.Description.Label = label;
            return asset;
        }

        private static void Share(HapticSurface surface, HapticMaterial asset)
        {
            using var serialized = new SerializedObject(surface);
            serialized.FindProperty("sharedMaterial").objectReferenceValue = asset;
            serialized.ApplyModifiedProperties();
        }

        private static LabelMix Read(HapticSurface surface)
        {
            Assert.That(SceneMaterial.TryRead(surface, out LabelMix mix, out _), Is.True);
            return mix;
        }
    }
}
