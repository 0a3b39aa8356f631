#nullable enable
using System.Collections;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;

namespace HaptoFlow.Tests
{
    /// <summary>Maps, objects and assets that change or are destroyed during a touch.</summary>
    public sealed class MapChangeTests : MapTest
    {
        [UnityTest]
        public IEnumerator AChangeOfTagOrLayerDuringATouchAppliesInTheNextFrame()
        {
            BoxCollider box = Bare();
            Map.Add(HapticMaterialRule.ForTag("Finish", Feeling("stone")));
            Map.Add(HapticMaterialRule.ForLayer(4, Feeling("glass")));
            Map.DefaultMaterial = Feeling("wood");
            HapticStylus stylus = Resting();
            var log = new TouchLog(stylus);
            yield return Frames(2);
            Assert.That(FeltAlone(stylus), Is.EqualTo("wood"));
            box.gameObject.tag = "Finish";
            yield return FeelsNext(stylus, "stone");
            box.gameObject.tag = "Untagged";
            box.gameObject.layer = 4;
            yield return FeelsNext(stylus, "glass");
            Assert.That(log.Began, Is.EqualTo(1), "the touch is not interrupted");
            Assert.That(log.Ended, Is.Zero);
        }

        [UnityTest]
        public IEnumerator AChangedRendererMaterialAppliesAndItsInstanceMatchesTheSameRule()
        {
            BoxCollider box = Bare();
            var renderer = box.gameObject.AddComponent<MeshRenderer>();
            Material oak = Paint("Oak");
            Material ice = Paint("Ice");
            Map.Add(HapticMaterialRule.ForRendererMaterial(oak, Feeling("wood")));
            Map.Add(HapticMaterialRule.ForRendererMaterial(ice, Feeling("glass")));
            renderer.sharedMaterial = oak;
            HapticStylus stylus = Resting();
            yield return Frames(2);
            Assert.That(FeltAlone(stylus), Is.EqualTo("wood"));
            renderer.sharedMaterial = ice;
            yield return FeelsNext(stylus, "glass");
            Material own = Keep(new Material(ice) { name = "Ice (Instance)" });
            renderer.sharedMaterial = own;
            yield return FeelsNext(stylus, "glass", "an instance made by Renderer.material");
        }

        [UnityTest]
        public IEnumerator AChangedOrDestroyedMapAppliesDuringATouch()
        {
            Bare();
            HapticMaterialRule rule = HapticMaterialRule.ForName("Plank", Feeling("wood"));
            Map.Add(rule);
            HapticStylus stylus = Resting();
            var log = new TouchLog(stylus);
            yield return Frames(2);
            rule.Material = Feeling("stone");
            yield return FeelsNext(stylus, "stone");
            HapticMaterialMap other = MapNamed("Other");
            other.DefaultMaterial = Feeling("fur");
            HaptoFlowSettings.Active.MaterialMap = other;
            yield return FeelsNext(stylus, "fur");
            Assert.That(log.Began, Is.EqualTo(1), "the touch is not interrupted");
            Object.DestroyImmediate(other);
            yield return null;
            Assert.That(stylus.IsTouching, Is.False);
            Assert.That(log.Ended, Is.EqualTo(1));
        }

        [UnityTest]
        public IEnumerator AMaterialDestroyedDuringATouchCausesNoError()
        {
            Bare();
            HapticMaterial wood = Feeling("wood");
            Map.DefaultMaterial = wood;
            HapticStylus stylus = Resting();
            yield return Frames(2);
            Object.DestroyImmediate(wood);
            yield return null;
            HapticMaterialMap.Refresh();
            yield return null;
            Assert.That(stylus.IsTouching, Is.False);
        }

        [UnityTest]
        public IEnumerator ANewNameAppliesAfterARefresh()
        {
            BoxCollider box = Bare();
            Map.Add(HapticMaterialRule.ForName("Rug*", Feeling("fur")));
            Map.DefaultMaterial = Feeling("wood");
            yield return Feels((0f, "wood"));
            box.gameObject.name = "Rug";
            HapticMaterialMap.Refresh();
            yield return Feels((0f, "fur"));
        }

        [UnityTest]
        public IEnumerator AHapticSurfaceAddedDuringATouchAppliesUntilItIsRemoved()
        {
            BoxCollider box = Bare();
            Map.DefaultMaterial = Feeling("wood");
            HapticStylus stylus = Resting();
            yield return Frames(2);
            var surface = box.gameObject.AddComponent<HapticSurface>();
            surface.Material.Label = "glass";
            yield return FeelsNext(stylus, "glass");
            Object.DestroyImmediate(surface);
            yield return FeelsNext(stylus, "wood");
        }
    }
}
