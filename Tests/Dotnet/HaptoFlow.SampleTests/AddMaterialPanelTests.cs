using System;
using System.IO;
using System.Text;
using System.Threading;
using HaptoFlow.SampleScenes;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    /// <summary>The panel of the Workshop, which learns a material while the scene runs.</summary>
    public sealed class AddMaterialPanelTests : SampleTest
    {
        private const double PatienceSeconds = 120.0;

        private Camera camera = null!;

        [SetUp]
        public void MakeCamera() => camera = CameraOf(new SceneFile("Workshop"));

        private static TextAsset Asset(string name) => new TextAsset(
            File.ReadAllBytes(Path.Combine(MadeRecordings.DoormatFolder, name)))
        {
            name = Path.GetFileNameWithoutExtension(name),
        };

        private WorkshopScene Open(out AddMaterialPanel panel)
        {
            WorkshopScene scene = Wake<WorkshopScene>(bootstrap => bootstrap.View = camera);
            panel = scene.gameObject.AddComponent<AddMaterialPanel>();
            World.Frame();
            panel.SetRecording(Asset("doormat.wav.bytes"), Asset("doormat.json"), Asset("doormat.motion.csv"));
            return scene;
        }

        private static void WaitFor(AddMaterialPanel panel)
        {
            DateTime end = DateTime.UtcNow.AddSeconds(PatienceSeconds);
            while (panel.IsLearning && DateTime.UtcNow < end)
            {
                World.Frame();
                Thread.Sleep(1);
            }
            Assert.That(panel.IsLearning, Is.False, panel.Text);
        }

        private void Press(AddMaterialPanel panel)
        {
            PointAt(camera, panel.Button!.transform.position);
            SimulatedInput.MouseButton = true;
            PlayFor(0.4);
        }

        [Test]
        public void TouchingTheButtonLearnsTheRecordingForTheSpecimen()
        {
            FinishLoading();
            WorkshopScene scene = Open(out AddMaterialPanel panel);
            Assert.That(panel.Text, Is.EqualTo("Touch to learn doormat"));
            Press(panel);
            Assert.That(panel.IsLearning, Is.True, panel.Text);
            SimulatedInput.MouseButton = false;
            WaitFor(panel);
            Assert.That(panel.Text, Does.StartWith("The specimen now feels like doormat; the nearest label is "));
            Assert.That(scene.SpecimenMaterial.IsLearnt, Is.True);
            HapticSession.Current.FinishRegistrations();
            PointAt(camera, new Vector3(0.27f, 0.005f, -0.16f));
            SimulatedInput.MouseButton = true;
            PlayFor(0.4);
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
}
