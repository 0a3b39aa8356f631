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

    /// <summary>Strokes drawn on the patch with pointer events.</summary>
    public sealed class PatchInputTests : PreviewWindowTest
    {
        private double clockSeconds;

        [SetUp]
        public void TakeTheClock()
        {
            clockSeconds = 40.0;
            Window.ClockSeconds = () => clockSeconds;
        }

        [TearDown]
        public void LetGo() => GUIUtility.hotControl = 0;

        private Box Patch => PreviewLayout.Patch(
            new PreviewLayout(Window.position.width, Window.position.height).StrokePanel);

        private bool Pointer(EventType type, double xMetres, double yMetres, PointerType pointer = PointerType.Mouse,
            float pressure = 0f, EventModifiers modifiers = EventModifiers.None)
        {
            (double x, double y) = PatchPicture.ToPoints(Patch, xMetres, yMetres);
            clockSeconds += 0.01;
            return Window.SendEvent(new Event
            {
                type = type,
                button = 0,
                mousePosition = new Vector2((float)x, (float)y),
                pointerType = pointer,
                pressure = pressure,
                modifiers = modifiers,
            });
        }

        /// <summary>Draws from left to right at 0.1 m/s.</summary>
        private void Draw(double yMetres, PointerType pointer = PointerType.Mouse, float pressure = 0f,
            EventModifiers modifiers = EventModifiers.None)
        {
            Pointer(EventType.MouseDown, 0.02, yMetres, pointer, pressure, modifiers);
            for (int step = 1; step <= 30; ++step)
            {
                Pointer(EventType.MouseDrag, 0.02 + 0.001 * step, yMetres, pointer, pressure, modifiers);
            }
            Pointer(EventType.MouseUp, 0.051, yMetres, pointer, pressure, modifiers);
        }

        [Test]
        public void DraggingOnThePatchDrawsAStrokeWithThePointersVelocity()
        {
            Draw(0.04);
            Assert.That(State.Preset, Is.EqualTo(StrokePreset.Drawn));
            StrokeState[] touched = Window.Session!.Stroke.States.Where(state => state.Touching).ToArray();
            Assert.That(touched, Has.Length.EqualTo(22).Within(1), "0.31 s at 72 Hz");
            Assert.That(touched.Select(state => state.VelocityXMps), Is.All.EqualTo(0.1).Within(0.002));
            Assert.That(touched.Select(state => state.VelocityYMps), Is.All.EqualTo(0.0).Within(0.002));
            Assert.That(touched.Select(state => state.ForceNewtons), Is.All.EqualTo(1.5).Within(1e-5));
            Window.Finish();
            Assert.That(Samples.Max(), Is.GreaterThan(0.001f));
#if HAPTOFLOW_OUTSIDE_UNITY
            Assert.That(Window.Player!.IsPlaying, Is.True, "as soon as it is rendered");
#endif
        }

        [Test]
        public void ASketchIsShownWhileAStrokeIsDrawn()
        {
            Pointer(EventType.MouseDown, 0.02, 0.04);
            Pointer(EventType.MouseDrag, 0.03, 0.04);
            Window.Step();
            Window.Session!.Finish();
            Assert.That(Window.Session.Shown!.Request.IsSketch, Is.True);
            Assert.That(Window.Session.IsFinal, Is.False);
            Pointer(EventType.MouseUp, 0.04, 0.04);
            Window.Step();
            Window.Session.Finish();
            Assert.That(Window.Session.Shown.Request.IsSketch, Is.False);
            Assert.That(Window.Session.IsFinal, Is.True);
        }

        [Test]
        public void APenAtHalfPressureHasTheForceThatIsSet()
        {
            Draw(0.04, PointerType.Pen, 0.75f);
            Assert.That(Window.Session!.Stroke.MaximumForceNewtons, Is.EqualTo(2.25).Within(1e-5));
        }

        [Test]
        public void ShiftAddsATouchToTheDrawnStroke()
        {
            Draw(0.02);
            Draw(0.06, modifiers: EventModifiers.Shift);
            Assert.That(Window.Session!.Stroke.States.Max(state => state.TouchCounter), Is.EqualTo(2u));
            Draw(0.04);
            Assert.That(Window.Session.Stroke.States.Max(state => state.TouchCounter), Is.EqualTo(1u));
        }

        [Test]
        public void ADrawnStrokeIsUndoneInOneStep()
        {
            Draw(0.04);
            Undo.PerformUndo();
            Assert.That(State.Preset, Is.EqualTo(StrokePreset.Slide));
            Assert.That(State.Drawn, Is.Empty);
        }

        [Test]
        public void ADragThatStartsBesideThePatchDrawsNothing()
        {
            Assert.That(Pointer(EventType.MouseDown, -0.01, 0.04), Is.False);
            Pointer(EventType.MouseDrag, 0.05, 0.04);
            Pointer(EventType.MouseUp, 0.06, 0.04);
            Assert.That(State.Preset, Is.EqualTo(StrokePreset.Slide));
        }
    }
}
