#nullable enable
using System;
using System.Globalization;
using System.IO;
using System.Text;
using HaptoFlow.Editor;
using HaptoFlow.Model;
using HaptoFlow.Preview;
using NUnit.Framework;
using UnityEditor;

namespace HaptoFlow.PreviewTests
{
    /// <summary>Opens a New Material window and makes a folder for recordings, and removes both after each test.
    /// </summary>
    public abstract class NewMaterialTest
    {
        internal string Folder { get; private set; } = "";

        internal NewMaterialWindow Window { get; private set; } = null!;

        internal NewMaterialState State => Window.State;

        [SetUp]
        public void OpenWindow()
        {
#if HAPTOFLOW_OUTSIDE_UNITY
            UnityShim.EditorSession.Begin(Tests.Support.RepositoryFiles.In("Packages", "com.haptoflow.runtime"));
#endif
            ProjectSettingsAsset.Forget();
            Folder = Path.Combine(Path.GetTempPath(), "haptoflow-recordings-" + Guid.NewGuid().ToString("N"));
            Directory.CreateDirectory(Folder);
            NewMaterialWindow.Open();
            Window = EditorWindow.GetWindow<NewMaterialWindow>();
            Undo.IncrementCurrentGroup();
        }

        [TearDown]
        public void CloseWindow()
        {
#if HAPTOFLOW_OUTSIDE_UNITY
            if (Window != null)
            {
                UnityShim.WindowHost.Close(Window);
            }
            UnityShim.EditorSession.End();
#else
            Window.Close();
#endif
            Directory.Delete(Folder, true);
            ProjectSettingsAsset.Forget();
        }

        /// <summary>The text of a label's material file.</summary>
        internal static string Jute() => MaterialText.OfLabel(ProjectSettingsAsset.DefaultModel()!.File, "jute");
    }

    /// <summary>The New Material window, with the real native library.</summary>
    public sealed class NewMaterialTests : NewMaterialTest
    {
        /// <summary>A recording of band-limited noise whose level follows the speed.</summary>
        private string Table(string name, string motion = ",speed_mps,force_newtons", double seconds = 4.0)
        {
            var random = new System.Random(7);
            var text = new StringBuilder("time_s,acceleration_mps2" + motion + "\n");
            double slow = 0.0;
            for (int index = 0; index < (int)(2000.0 * seconds); ++index)
            {
                double time = index / 2000.0;
                double speed = 0.06 + 0.04 * Math.Sin(1.7 * time);
                slow += 0.45 * (2.0 * random.NextDouble() - 1.0 - slow);
                text.Append(time.ToString("0.0000", CultureInfo.InvariantCulture)).Append(',')
                    .Append((40.0 * speed * slow).ToString("0.00000", CultureInfo.InvariantCulture));
                if (motion.Length > 0)
                {
                    text.Append(',').Append(speed.ToString("0.00000", CultureInfo.InvariantCulture)).Append(",1.2");
                }
                text.Append('\n');
            }
            return File(name, text.ToString());
        }

        private string File(string name, string text)
        {
            string path = Path.Combine(Folder, name);
            System.IO.File.WriteAllText(path, text);
            return path;
        }

        private string? Obstacle() => Window.Session!.Obstacle(ProjectSettingsAsset.DefaultModel());

        [Test]
        public void ARecordingIsReadInTheBackgroundAndNamedAfterItsFile()
        {
            File("Denim.json", "{\"licence\": \"CC BY 4.0\"}");
            Window.Take(Table("Denim.csv"));
            Window.Finish();
            Assert.That(Window.Session!.Problem, Is.Null);
            Assert.That(Window.Session.Shown!.Sounds, Has.Count.EqualTo(1));
            Assert.That((State.Name, State.Licence), Is.EqualTo(("denim", "CC BY 4.0")));
            Assert.That(NewMaterialControls.Describe(Window.Session.Recording!),
                Is.EqualTo("Denim: 4.0 s, one axis at 2000 Hz, speed from the file, force from the file."));
            Assert.That(Obstacle(), Is.Null);
        }

        [Test]
        public void AnInvalidFileIsReportedAndTheSettingsAreKept()
        {
            Window.Take(Table("good.csv"));
            Window.Finish();
            State.Change("Name", changed => changed.Name = "my denim");
            State.Change("Recording", changed => changed.Path = File("bad.csv", "time_s,acceleration\n0,1\n"));
            Window.Finish();
            Assert.That(Window.Session!.Problem, Does.StartWith("bad.csv: columns time_s, acceleration; expected"));
            Assert.That(Obstacle(), Does.StartWith("Choose a recording"));
            Assert.That(State.Name, Is.EqualTo("my denim"));
            State.Change("Recording", changed => changed.Path = Path.Combine(Folder, "good.csv"));
            Window.Finish();
            Assert.That((Window.Session.Problem, Obstacle()), Is.EqualTo(((string?)null, (string?)null)));
        }

        [Test]
        public void TheLearntMaterialIsShownBesideTheRecordingWithUndo()
        {
            Window.Take(Table("a.csv"));
            Window.Finish();
            Undo.IncrementCurrentGroup();
            State.Change("Material", changed => changed.Material = Jute());
            Window.Finish();
            Assert.That(Window.Session!.Problem, Is.Null);
            Assert.That(Window.Session.Shown!.Sounds, Has.Count.EqualTo(2));
            Assert.That(Window.Player!.PlayedSound!.Sound.Title, Is.EqualTo("jute"));
            State.Change("Side", changed => changed.Active = 0);
            Window.Finish();
            Assert.That(Window.Player.PlayedSound!.Sound.Title, Is.EqualTo("recording"));
            Undo.PerformUndo();
            Window.Finish();
            Assert.That(Window.Session.Shown.Sounds, Has.Count.EqualTo(1));
        }

        [Test]
        public void ALearntMaterialIsSavedForTheProjectsModel()
        {
            Window.Take(Table("denim.csv", ",speed_mps,force_newtons", 10.0));
            Window.Finish();
            Window.Learn();
            HapticLearning learning = Window.Session!.Learning!;
            Window.Learn();
            Assert.That(Window.Session.Learning, Is.SameAs(learning), "only one learning runs at a time");
            Window.Finish();
            Assert.That(Window.Session.Problem, Is.Null);
            Assert.That(learning.Share, Is.GreaterThan(0f));
            Assert.That(learning.Doing, Is.Not.Empty);
            MaterialFile material = MaterialFile.Read(State.Material);
            byte[] model = ProjectSettingsAsset.DefaultModel()!.File;
            Assert.That((material.Name, material.Space, material.Licence),
                Is.EqualTo(("denim", ModelHeader.Read(model).Space, "unknown")));
            Assert.That(Window.Session.Report!.Sentences, Does.StartWith("Learnt. Nearest label: "));
            Assert.That(Window.Session.Shown!.Sounds, Has.Count.EqualTo(2));
            double decibels = 20.0 * Math.Log10(
                Window.Session.Shown.Sounds[1].Sound.RmsMps2 / Window.Session.Shown.Sounds[0].Sound.RmsMps2);
            Assert.That(decibels, Is.InRange(-3.0, 3.0));
            HapticMaterial saved = MaterialAssets.Save("Assets/NewMaterialTests.asset", State.Material, "wood");
            Assert.That(saved.Learnt, Is.EqualTo(State.Material));
            AssetDatabase.DeleteAsset("Assets/NewMaterialTests.asset");
        }

        [Test]
        public void TheReportStatesTheAngleOfRibs()
        {
            const string Ruled = "{\"nearest_label\": \"corduroy\", \"turn_degrees\": 29.4}";
            Assert.That(LearningReport.Read(Ruled)!.Sentences,
                Does.Contain("the first axis is perpendicular to the ribs, 29 degrees from the recording's"));
            Assert.That(LearningReport.Read(Ruled)!.TurnDegrees, Is.EqualTo(29.4));
            const string Plain = "{\"nearest_label\": \"wood\", \"turn_degrees\": 0}";
            Assert.That(LearningReport.Read(Plain)!.Sentences, Does.Not.Contain("ribs"));
        }

        [TestCase("{\"mps2\": 0.0382, \"from\": \"rest\"}", "; 0.038 m/s^2 of the sensor's noise removed")]
        [TestCase("{\"mps2\": 0, \"from\": \"none\"}", "")]
        public void TheReportStatesTheNoiseThatWasRemoved(string noise, string text) => Assert.That(
            LearningReport.Read("{\"nearest_label\": \"wood\", \"sensor_noise\": " + noise + "}")!.Sentences,
            Is.EqualTo("Learnt. Nearest label: wood" + text + "."));

        [Test]
        public void CancellingKeepsTheMaterialLearntBefore()
        {
            Window.Take(Table("denim.csv", ",speed_mps,force_newtons", 10.0));
            Window.Finish();
            State.Change("Material", changed => changed.Material = "kept");
            Window.Learn();
            HapticLearning learning = Window.Session!.Learning!;
            Window.Session.Cancel();
            Window.Finish();
            Assert.That((learning.IsCancelled, learning.Problem), Is.EqualTo((true, (string?)null)));
            Assert.That(State.Material, Is.EqualTo("kept"));
        }

        [Test]
        public void ARecordingWithoutMotionIsRefused()
        {
            var text = new StringBuilder("time_s,acceleration_mps2,speed_mps,force_newtons\n");
            for (int index = 0; index < 20000; ++index)
            {
                text.Append(FormattableString.Invariant($"{index / 2000.0:0.0000},{0.001 * (index % 7)},0,0\n"));
            }
            Window.Take(File("rest.csv", text.ToString()));
            Window.Finish();
            Window.Learn();
            Window.Finish();
            Assert.That(Window.Session!.Problem, Is.Not.Null);
            Assert.That(State.Material, Is.Empty);
        }
    }
}
