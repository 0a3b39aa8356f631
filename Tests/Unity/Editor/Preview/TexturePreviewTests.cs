#nullable enable
using System.IO;
using System.Linq;
using HaptoFlow.Editor;
using HaptoFlow.Preview;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.PreviewTests
{
    /// <summary>The Texture Preview window, with the real native library and the default model.</summary>
    public sealed class TexturePreviewTests : PreviewWindowTest
    {
        [Test]
        public void ChoosingALabelRendersIt()
        {
            Window.Finish();
            float[] wood = Samples;
            State.Change("Label", state => state.First.Label = "rubber");
            Window.Finish();
            Assert.That(Window.Player!.PlayedSound!.Sound.Material, Is.EqualTo(new LabelMix("rubber")));
            Assert.That(Samples, Is.Not.EqualTo(wood));
            Assert.That(Window.Session!.Problem, Is.Null);
        }

        [Test]
        public void UndoRestoresTheLabelAndItsSound()
        {
            Window.Finish();
            float[] wood = Samples;
            State.Change("Label", state => state.First.Label = "rubber");
            Window.Finish();
            Undo.PerformUndo();
            Assert.That(State.First.Label, Is.EqualTo("wood"));
            Window.Finish();
            Assert.That(Samples, Is.EqualTo(wood));
        }

        [Test]
        public void RenderingHappensInTheBackground()
        {
            Window.Step();
            Assert.That(Window.Session!.IsBusy, Is.True);
            Assert.That(Window.Session.Shown, Is.Null);
            Window.Session.Finish();
            Assert.That(Window.Session.Shown, Is.Not.Null);
            Assert.That(Window.Session.IsBusy, Is.False);
            Window.Step();
            Assert.That(Window.Session.IsBusy, Is.False, "nothing has changed");
        }

        [Test]
        public void ASketchIsShownWhileAControlIsDragged()
        {
            GUIUtility.hotControl = 1;
            State.Change("Speed", state => state.SpeedMps = 0.2f);
            Window.Step();
            GUIUtility.hotControl = 0;
            Window.Session!.Finish();
            Assert.That(Window.Session.Shown!.Request.IsSketch, Is.True);
            Assert.That(Window.Session.IsFinal, Is.False);
            Window.Step();
            Window.Session.Finish();
            Assert.That(Window.Session.Shown.Request.IsSketch, Is.False);
            Assert.That(Window.Session.IsFinal, Is.True);
        }

        [Test]
        public void AnExportedFileContainsTheActiveSound()
        {
            string path = TemporaryFile();
            Assert.That(Window.ExportTo(path), Is.Null);
            var file = new WaveReader(File.ReadAllBytes(path));
            Assert.That(file.Samples(), Is.EqualTo(Samples));
            Assert.That(file.Samples().Max(), Is.GreaterThan(0.001f));
            Assert.That((file.RateHz, file.Channels), Is.EqualTo((48000, 1)));
            File.Delete(path);
        }

        [Test]
        public void AFileThatCannotBeWrittenIsReported() => Assert.That(
            Window.ExportTo(Path.Combine("Temp", "no", "such", "folder", "a.wav")), Is.Not.Null.And.Not.Empty);

        [Test]
        public void TheKeysAAndBSwitchBetweenTheMaterials()
        {
            Window.Finish();
            float[] wood = Samples;
            Assert.That(Key(KeyCode.B), Is.True);
            Window.Finish();
            Assert.That(Window.Player!.PlayedSound!.Sound.Material, Is.EqualTo(new LabelMix("sandpaper")));
            Assert.That(Window.Session!.Shown!.Sounds, Has.Count.EqualTo(2), "the active material is shown");
            Assert.That(Key(KeyCode.A), Is.True);
            Window.Finish();
            Assert.That(Samples, Is.EqualTo(wood));
        }

        [Test]
        public void ArrowKeysChangeSpeedAndForceWithinTheirRanges()
        {
            Key(KeyCode.RightArrow);
            Key(KeyCode.RightArrow);
            Assert.That(State.SpeedMps, Is.EqualTo(0.12 * System.Math.Sqrt(2.0)).Within(1e-5));
            Key(KeyCode.LeftArrow);
            Key(KeyCode.LeftArrow);
            Assert.That(State.SpeedMps, Is.EqualTo(0.12).Within(1e-5));
            for (int press = 0; press < 40; ++press)
            {
                Key(KeyCode.UpArrow);
            }
            Assert.That(State.ForceNewtons, Is.EqualTo(5f));
            for (int press = 0; press < 60; ++press)
            {
                Key(KeyCode.DownArrow);
            }
            Assert.That(State.ForceNewtons, Is.EqualTo(0.05f));
        }

        [Test]
        public void OtherKeysAreNotUsed()
        {
            Assert.That(Key(KeyCode.E), Is.False);
            Assert.That(Key(KeyCode.A, EventModifiers.Alt), Is.False);
            Assert.That(Key(KeyCode.None), Is.False);
        }

        [Test]
        public void ADamagedModelIsReportedUntilAnotherIsChosen()
        {
            byte[] damaged = (byte[])DefaultFile().Clone();
            damaged[100] ^= 1;
            HapticModelAsset bad = Model(damaged);
            State.Change("Model", state => state.Model = bad);
            Window.Finish();
            Assert.That(Window.Session!.Problem,
                Does.StartWith("The model made cannot be used").And.Contain("checksum"));
            Assert.That(Window.ExportTo(TemporaryFile()), Does.Contain("checksum"));
            State.Change("Model", state => state.Model = null);
            Window.Finish();
            Assert.That(Window.Session.Problem, Is.Null);
        }

        [Test]
        public void DamageAfterTheHeaderIsReported()
        {
            byte[] damaged = (byte[])DefaultFile().Clone();
            damaged[damaged.Length - 100] ^= 1;
            HapticModelAsset bad = Model(damaged);
            State.Change("Model", state => state.Model = bad);
            Window.Finish();
            Assert.That(Window.Session!.Problem, Does.Contain("checksum"));
            Assert.That(Window.Session.Model.Labels, Is.Empty, "no part of a damaged file is used");
        }

        [Test]
        public void ALabelThatTheModelLacksIsReported()
        {
            State.Change("Label", state => state.First.Label = "granite");
            Window.Finish();
            Assert.That(Window.Session!.Problem, Does.Contain("\"granite\""));
        }

        [Test]
        public void TheFirstLabelsAndTheDefaultTierAreUsedByDefault()
        {
            State.First.Label = "";
            State.Second.Label = "";
            State.Tier = "";
            State.Change("Compare", state => state.Compares = true);
            Window.Finish();
            PreviewRequest shown = Window.Session!.Shown!.Request;
            Assert.That(shown.Materials, Is.EqualTo(new[]
            {
                new LabelMix(Window.Session.Model.Labels[0]), new LabelMix(Window.Session.Model.Labels[1]),
            }));
            Assert.That(shown.Tier, Is.EqualTo(Window.Session.Model.DefaultTier));
        }

        [Test]
        public void ASecondLabelIsBlendedIn()
        {
            Window.Finish();
            float[] wood = Samples;
            State.Change("Blend", state =>
            {
                state.First.SecondLabel = "sandpaper";
                state.First.Share = 0.25f;
            });
            Window.Finish();
            Assert.That(Window.Player!.PlayedSound!.Sound.Material, Is.EqualTo(new LabelMix("wood", "sandpaper", 0.25f)));
            Assert.That(Samples, Is.Not.EqualTo(wood));
        }

        [Test]
        public void TheTableHasATimeForEveryTier()
        {
            Window.Finish();
            int tiers = ProjectSettingsAsset.DefaultModel()!.Header.Tiers.Count;
            Assert.That(Window.Session!.Shown!.Qualities, Has.Count.EqualTo(tiers));
            Assert.That(Window.Session.Shown.Qualities.Select(row => row.Timing!.MedianMs), Is.All.GreaterThan(0.0));
        }

        [Test]
        public void AClosedWindowCanBeOpenedAgain()
        {
            Window.Finish();
            Close();
            Assert.That(Window == null, Is.True);
            OpenWindow();
            Window!.Finish();
            Assert.That(Window.Session!.Problem, Is.Null);
            Assert.That(Samples, Is.Not.Empty);
        }
    }
}
