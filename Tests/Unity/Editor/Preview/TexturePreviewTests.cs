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
        public void ChoosingALabelRendersItAndUndoTheOneBefore()
        {
            Window.Finish();
            float[] wood = Samples;
            State.Change("Label", state => state.First.Label = "rubber");
            Window.Finish();
            Assert.That(Window.Player!.PlayedSound!.Sound.Material, Is.EqualTo(new LabelMix("rubber")));
            Assert.That(Samples, Is.Not.EqualTo(wood));
            Assert.That(Window.Session!.Problem, Is.Null);
            Undo.PerformUndo();
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
    }
}
