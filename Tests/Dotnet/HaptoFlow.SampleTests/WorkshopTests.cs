using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text;
using System.Threading;
using HaptoFlow.SampleScenes;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    public sealed class WorkshopTests : SampleTest
    {
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
            Assert.That(All<RuleBoard>().Single().Text,
                Does.StartWith(name + ": rule ").And.EndsWith($"of \"Workshop\": {rule}"));
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
                PointAt(new Vector3(x, 0.01f, 0.1f));
                World.Frame();
                Assert.That(scene.Pen.Stylus.IsTouching, Is.True, $"{x} m");
            }
            Assert.That(Loudest(), Is.GreaterThan(Audible));
        }

        [Test]
        public void EveryColliderMatchesARuleAndEveryRuleMatchesACollider()
        {
            WorkshopScene scene = Open();
            PlayFor(0.05);
            IEnumerable<MappedPart> parts = All<Collider>()
                .Where(collider => !collider.transform.IsChildOf(scene.Pen.transform))
                .SelectMany(collider => MappedColliders.Resolve(collider)!.Parts);
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

        private void Press(float x, float z) => Press(new Vector3(x, 0.005f, z), 0.4);

        private WorkshopScene Open() => Open<WorkshopScene>("Workshop");
    }

    public sealed class AddMaterialPanelTests : SampleTest
    {
        private static TextAsset Asset(string name) => new TextAsset(
            File.ReadAllBytes(Path.Combine(MadeRecordings.DoormatFolder, name)))
        {
            name = Path.GetFileNameWithoutExtension(name),
        };

        private WorkshopScene Open(out AddMaterialPanel panel)
        {
            WorkshopScene scene = Open<WorkshopScene>("Workshop");
            panel = scene.gameObject.AddComponent<AddMaterialPanel>();
            World.Frame();
            panel.SetRecording(Asset("doormat.wav.bytes"), Asset("doormat.json"), Asset("doormat.motion.csv"));
            return scene;
        }

        private static void WaitFor(AddMaterialPanel panel)
        {
            DateTime end = DateTime.UtcNow.AddMinutes(2.0);
            while (panel.IsLearning && DateTime.UtcNow < end)
            {
                World.Frame();
                Thread.Sleep(1);
            }
            Assert.That(panel.IsLearning, Is.False, panel.Text);
        }

        [Test]
        public void TouchingTheButtonLearnsTheRecordingForTheSpecimen()
        {
            FinishLoading();
            WorkshopScene scene = Open(out AddMaterialPanel panel);
            Assert.That(panel.Text, Is.EqualTo("Touch to learn doormat"));
            Press(panel.Button!.transform.position, 0.4);
            Assert.That(panel.IsLearning, Is.True, panel.Text);
            SimulatedInput.MouseButton = false;
            WaitFor(panel);
            Assert.That(panel.Text, Does.StartWith("The specimen now feels like doormat; the nearest label is "));
            Assert.That(scene.SpecimenMaterial.IsLearnt, Is.True);
            HapticSession.Current.FinishRegistrations();
            Press(new Vector3(0.27f, 0.005f, -0.16f), 0.4);
            Assert.That(scene.Pen.Stylus.Contact.Material, Is.SameAs(scene.SpecimenMaterial.Description));
            Assert.That(scene.Pen.Stylus.Contact.Labels.Label(0), Is.GreaterThanOrEqualTo(Haptics.Labels.Count));
            Assert.That(Haptics.LearntMaterials, Is.EqualTo(1));
        }

        [Test]
        public void ASecondPressCancelsAndTheSpecimenKeepsItsMaterial()
        {
            WorkshopScene scene = Open(out AddMaterialPanel panel);
            panel.Press();
            panel.Press();
            WaitFor(panel);
            Assert.That(panel.Text, Is.EqualTo("Cancelled"));
            Assert.That((scene.SpecimenMaterial.IsLearnt, scene.SpecimenMaterial.Description.Label), Is.EqualTo((false, "cardboard")));
        }

        [TestCase("", "is empty")]
        [TestCase("time_s,acceleration_mps2\n0,1\n0.001,2\n0.002,1\n0.003,3\n", "no motion in it or beside it")]
        [TestCase("time_s,acceleration\n0,1\n", "expected acceleration")]
        public void AnInvalidRecordingIsReportedAndTheSceneContinues(string text, string message)
        {
            Open(out AddMaterialPanel panel);
            panel.SetRecording(new TextAsset(Encoding.UTF8.GetBytes(text)) { name = "mine.csv" });
            panel.Press();
            WaitFor(panel);
            Assert.That(panel.Text, Does.StartWith("Nothing was learnt: mine.csv: ").And.Contain(message));
            panel.Press();
            WaitFor(panel);
            Assert.That(panel.Text, Does.Contain(message), "it can be tried again");
        }

        [Test]
        public void EndingTheSceneEndsTheLearning()
        {
            WorkshopScene scene = Open(out AddMaterialPanel panel);
            panel.Press();
            World.Frames(3);
            UnityEngine.Object.DestroyImmediate(scene.gameObject);
            World.Frames(3);
            HapticLearning.EndAll();
            Assert.That(panel == null, Is.True);
        }
    }

    public sealed class TextureGalleryTests : SampleTest
    {
        [Test]
        public void TilesAndBoardAreInTheCamerasViewAndDoNotOverlap()
        {
            GalleryScene gallery = Open();
            List<Transform> places = gallery.Tiles.Append(gallery.Board).Select(surface => surface.transform).ToList();
            foreach (Transform place in places)
            {
                foreach (float side in new[] { -0.5f, 0.5f })
                {
                    Vector3 pixels = camera.WorldToScreenPoint(place.position + side * place.localScale);
                    Assert.That(pixels.x, Is.InRange(0f, camera.pixelWidth), place.name);
                    Assert.That(pixels.y, Is.InRange(0f, camera.pixelHeight), place.name);
                }
                foreach (Transform other in places.Where(other => other != place))
                {
                    Vector3 apart = other.position - place.position;
                    Vector3 reach = 0.5f * (other.localScale + place.localScale);
                    bool touching = Math.Abs(apart.x) < reach.x && Math.Abs(apart.y) < reach.y;
                    Assert.That(touching, Is.False, $"{place.name} and {other.name}");
                }
            }
        }

        [Test]
        public void PressingATilePicksItsLabelForTheBoard()
        {
            FinishLoading();
            GalleryScene gallery = Open();
            Assert.That(gallery.Tiles.Select(tile => tile.Material.Label),
                Is.EqualTo(HaptoFlowSettings.Active.Model!.Header.Labels.Select(label => label.Name)));
            HapticSurface fur = gallery.Tiles.Single(tile => tile.Material.Label == "fur");
            Assert.That(gallery.Board.Material.Label, Is.Not.EqualTo("fur"));
            Press(fur.transform.position, 0.3);
            Assert.That(gallery.Pen.Stylus.Contact.Surface, Is.SameAs(fur));
            Assert.That(gallery.Board.Material.Label, Is.EqualTo("fur"));

            SimulatedInput.MouseButton = false;
            PlayFor(0.2);
            AudioDevice.Forget();
            SimulatedInput.MouseButton = true;
            for (int frame = 0; frame < 0.8 * World.FrameRateHz; ++frame)
            {
                float x = 0.1f * (float)Math.Sin(2.0 * Math.PI * frame / World.FrameRateHz);
                PointAt(gallery.Board.transform.position + new Vector3(x, 0f, 0f));
                World.Frame();
            }
            Assert.That(gallery.Pen.Stylus.Contact.Surface, Is.SameAs(gallery.Board));
            Assert.That(gallery.Board.Material.Label, Is.EqualTo("fur"));
            Assert.That(StatisticsOf(gallery.Pen.Stylus).Inferences, Is.GreaterThan(0UL));
            Assert.That(Loudest(), Is.GreaterThan(Audible));
        }

        [Test]
        public void WithoutAModelTheWallIsEmptyAndTheBoardShowsTheReason()
        {
            HapticSession.ShutDown();
            HaptoFlowSettings.Active.Model = null;
            GalleryScene gallery = Open();
            PlayFor(0.5);
            Assert.That(gallery.Tiles, Is.Empty);
            Assert.That(All<StatusBoard>().Single().Text, Does.Contain("no model is chosen"));
        }

        private GalleryScene Open() => Open<GalleryScene>("TextureGallery");
    }
}
