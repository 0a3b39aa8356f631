using System;
using System.IO;
using System.Linq;
using System.Text.RegularExpressions;
using HaptoFlow.SampleScenes;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    public sealed class WorkshopTests : SampleTest
    {
        private Camera camera = null!;

        [SetUp]
        public void MakeCamera() => camera = CameraOf(new SceneFile("Workshop"));

        [TestCase("Bench", 0.46f, 0f, "wood", "name \"Bench\"")]
        [TestCase("Puddle", 0.02f, -0.16f, "glass", "layer \"Water\"")]
        [TestCase("Specimen", 0.27f, -0.16f, "cardboard", "name \"Specimen\"")]
        [TestCase("Two Halves", 0.15f, 0.1f, "wood", "renderer material \"Oak\"")]
        [TestCase("Two Halves", 0.33f, 0.1f, "metal mesh", "renderer material \"Steel\"")]
        [TestCase("Inlaid Pane", -0.25f, -0.16f, "ceramic", "name \"Inlaid Pane\"")]
        [TestCase("Inlaid Pane", -0.195f, -0.16f, "jute", "name \"Inlaid Pane\"")]
        [TestCase("Garden", -0.42f, 0.1f, "concrete", "terrain layer \"Gravel\"")]
        [TestCase("Garden", -0.24f, 0.1f, "carpet", "terrain layer \"Turf\"")]
        [TestCase("Garden", -0.06f, 0.1f, "sandpaper", "terrain layer \"Sand\"")]
        public void EveryObjectHasTheMaterialOfItsRuleAndTheBoardShowsTheRule(
            string name, float x, float z, string label, string rule)
        {
            FinishLoading();
            WorkshopScene scene = Open();
            Press(x, z);
            Assert.That(scene.Pen.Stylus.IsTouching, Is.True);
            HapticContact contact = scene.Pen.Stylus.Contact;
            Assert.That(contact.Collider.name, Is.EqualTo(name));
            Assert.That(contact.Surface, Is.Null, "none of these things is tagged");
            Assert.That(contact.Material!.Label, Is.EqualTo(label));
            RuleBoard board = UnityEngine.Object.FindObjectsByType<RuleBoard>(
                FindObjectsInactive.Exclude, FindObjectsSortMode.None).Single();
            Assert.That(board.Text, Does.StartWith(name + ": rule ").And.EndsWith($"of \"Workshop\": {rule}"));
        }

        [Test]
        public void AStrokeFromGravelToSandIsFeltWithoutAGap()
        {
            FinishLoading();
            WorkshopScene scene = Open();
            Press(-0.42f, 0.1f);
            AudioDevice.Forget();
            for (int frame = 0; frame < World.FrameRateHz; ++frame)
            {
                float x = -0.42f + 0.36f * frame / (float)World.FrameRateHz;
                PointAt(camera, new Vector3(x, 0.01f, 0.1f));
                World.Frame();
                Assert.That(scene.Pen.Stylus.IsTouching, Is.True, $"{x} m");
            }
            Assert.That(Loudest(), Is.GreaterThan(Audible));
        }

        [Test]
        public void ANewMaterialOfTheSpecimenIsFeltInTheNextStroke()
        {
            FinishLoading();
            WorkshopScene scene = Open();
            Press(0.27f, -0.16f);
            scene.SpecimenMaterial.Description.Label = "leather";
            PlayFor(0.05);
            Assert.That(scene.Pen.Stylus.Contact.Material!.Label, Is.EqualTo("leather"));
        }

        [Test]
        public void EveryColliderMatchesARuleAndEveryRuleMatchesACollider()
        {
            WorkshopScene scene = Open();
            PlayFor(0.05);
            Collider[] colliders = UnityEngine.Object.FindObjectsByType<Collider>(
                FindObjectsInactive.Exclude, FindObjectsSortMode.None);
            MappedPart[] parts = colliders.Where(collider => !collider.transform.IsChildOf(scene.Pen.transform))
                .SelectMany(collider => MappedColliders.Resolve(collider)!.Parts).ToArray();
            Assert.That(parts.Select(part => part.Rule).Distinct(),
                Is.EquivalentTo(Enumerable.Range(0, scene.Map.Rules.Count)));
        }

        [Test]
        public void TheSceneDestroysTheAssetsThatItCreated()
        {
            WorkshopScene scene = Open();
            HapticMaterialMap map = scene.Map;
            UnityEngine.Object.DestroyImmediate(scene.gameObject);
            World.Frame();
            Assert.That(map == null, Is.True);
            Assert.That(MaterialMaps.Any, Is.False);
        }

        /// <summary>Lowers the pen onto a place of the bench.</summary>
        private void Press(float x, float z)
        {
            PointAt(camera, new Vector3(x, 0.005f, z));
            SimulatedInput.MouseButton = true;
            PlayFor(0.4);
        }

        private WorkshopScene Open() => Wake<WorkshopScene>(bootstrap => bootstrap.View = camera);
    }
}
