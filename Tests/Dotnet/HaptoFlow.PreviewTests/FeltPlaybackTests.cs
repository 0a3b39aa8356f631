using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Editor;
using HaptoFlow.Outputs;
using HaptoFlow.Preview;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.PreviewTests
{
    /// <summary>The Texture Preview on a connected gamepad or controller.</summary>
    public sealed class FeltPlaybackTests : PreviewWindowTest
    {
        private const double UpdateSeconds = 0.01;

        [SetUp]
        [TearDown]
        public void ForgetDevices() => HeldDevices.Reset();

        [SetUp]
        public void ChooseALongStroke() => State.ContactSeconds = 4f;

        [Test]
        public void AGamepadGetsTheEnvelopeWhileTheSoundPlaysAndStopsWithIt()
        {
            HeldGamepad pad = HeldGamepad.Take("A pad");
            Play(0.2);
            Assert.That(pad.Speeds, Is.Empty, "no device was chosen");
            Press("Stop");
            State.Change("Device", state => state.FeltOn = FeltDevice.Gamepad);
            Updates(0.2);
            Assert.That(pad.Speeds, Is.Empty, "nothing plays yet");
            Play(0.25);
            Assert.That(Strengths(pad).Max(), Is.InRange(0.08f, 1f));
            Assert.That(pad.Speeds.Count, Is.InRange(4, 18), "at most 60 a second, fewer while nothing changes");
            Press("Stop");
            Assert.That(Strengths(pad).Last(), Is.Zero);
            int sent = pad.Speeds.Count;
            Updates(0.3);
            Assert.That(pad.Speeds, Has.Count.EqualTo(sent));
        }

        [Test]
        public void ARealDeviceNeverPlaysTheSoundOfASimulatedOne()
        {
            HeldGamepad pad = FeelPad();
            Play(1.0);
            (float, float)[] direct = pad.Speeds.Select(each => (each.Low, each.High)).ToArray();
            Press("Stop");
            State.Change("Device", state =>
            {
                state.Device = PreviewDevice.Motor;
                state.Active = 1;
            });
            Window.Finish();
            int sent = pad.Speeds.Count;
            Play(1.0);
            Assert.That(Window.Player!.PlayedSound!.Sound.Title, Does.Contain("motor"));
            double expected = direct.Skip(10).Average(each => each.Item1 + each.Item2);
            Assert.That(Strengths(pad).Skip(sent + 10).Average(), Is.EqualTo(expected).Within(0.05 * expected));
        }

        [Test]
        public void APadThatIsPulledOutAndReturnsIsFeltAgain()
        {
            HeldGamepad pad = FeelPad();
            Play(0.5);
            pad.IsCurrent = false;
            Updates(0.5);
            int sent = pad.Speeds.Count;
            Assert.That(Remarks(), Has.Member("no gamepad is connected"));
            pad.IsCurrent = true;
            Updates(1.0);
            Assert.That(pad.Speeds.Count, Is.GreaterThan(sent + 10));
            Assert.That(Remarks(), Has.Some.StartsWith("A pad, envelope"));
        }

        [Test]
        public void AnotherPadTakesOverAndTheFirstOneStops()
        {
            HeldGamepad first = FeelPad();
            Play(0.5);
            HeldGamepad second = HeldGamepad.Take("Another pad");
            Updates(0.5);
            Assert.That(Strengths(first).Last(), Is.Zero);
            Assert.That(Strengths(second).Max(), Is.GreaterThan(0.05f));
        }

        [TestCase(false)]
        [TestCase(true)]
        public void ClosingTheWindowOrReloadingScriptsStopsTheMotors(bool reloads)
        {
            HeldGamepad pad = FeelPad();
            Play(0.5);
            Assert.That(Strengths(pad).Last(), Is.GreaterThan(0f));
            if (reloads)
            {
                WindowHost.Reload(Window);
            }
            else
            {
                Close();
            }
            Assert.That(Strengths(pad).Last(), Is.Zero);
        }

        [Test]
        public void ChoosingNoneStopsTheMotorsAndTheSpeakersPlayOn()
        {
            HeldGamepad pad = FeelPad();
            Play(0.5);
            Undo.IncrementCurrentGroup();
            EditorScreen.Enter("Feel on", (int)FeltDevice.None);
            WindowHost.Draw(Window);
            Window.Finish();
            Updates(0.05);
            Assert.That(Strengths(pad).Last(), Is.Zero);
            Assert.That(Window.Player!.IsPlaying, Is.True);
            Undo.PerformUndo();
            Assert.That(State.FeltOn, Is.EqualTo(FeltDevice.Gamepad));
        }

        [Test]
        public void AControllerOfAHeadsetIsFoundInPlayModeOnly()
        {
            XrHand.Right.Take("Some controller", true);
            State.Change("Device", state => state.FeltOn = FeltDevice.LeftHand);
            Play(0.5);
            Assert.That(Remarks(), Has.Member("no haptic device in this hand").Or.Member("found in Play mode only"));
            EditorSession.Play();
            State.Change("Device", state => state.FeltOn = FeltDevice.RightHand);
            Window.Finish();
            Updates(1.0);
            Assert.That(XrHand.Right.Impulses.Count, Is.GreaterThan(30));
            Assert.That(XrHand.Left.Impulses, Is.Empty);
            Assert.That(Remarks(), Has.Some.StartsWith("Some controller, envelope"));
        }

        [Test]
        public void AControllerThatTakesWaveformsGetsTheWaveform()
        {
            XrHand.Left.Take("A controller with buffers", true, 500u);
            EditorSession.Play();
            State.Change("Device", state => state.FeltOn = FeltDevice.LeftHand);
            Play(1.0);
            Assert.That(XrHand.Left.Buffers.Sum(each => each.Bytes.Length), Is.InRange(350, 750));
            Assert.That(XrHand.Left.Buffers.Max(each => each.Bytes.Max()), Is.GreaterThan(20));
            Assert.That(Remarks(), Has.Some.StartsWith("A controller with buffers, waveform"));
        }

        [Test]
        public void OutputsOfASceneThatPlaysLeaveTheHandToThePreview()
        {
            XrHand.Right.Take("Some controller", true);
            EditorSession.Play();
            State.Change("Device", state => state.FeltOn = FeltDevice.RightHand);
            Play(0.5);
            Assert.That(HandYields.UntilSeconds(HapticHand.Right), Is.GreaterThan(Time.realtimeSinceStartupAsDouble));
            Assert.That(HandYields.UntilSeconds(HapticHand.Left), Is.LessThan(Time.realtimeSinceStartupAsDouble));
            Press("Stop");
            Updates(0.5);
            Assert.That(HandYields.UntilSeconds(HapticHand.Right), Is.LessThan(Time.realtimeSinceStartupAsDouble));
        }

        [Test]
        public void TheProjectsCeilingLimitsThePreviewOnADevice()
        {
            State.First.Label = "sandpaper";
            ProjectSettingsAsset.FindOrCreate().Ceiling = 0.1f;
            HeldGamepad pad = FeelPad();
            Play(1.0);
            Assert.That(Strengths(pad).Max(), Is.InRange(0.05f, 0.1001f));
        }

        [Test]
        public void WithoutTheEditorsClipPlayerADevicePlaysToTheEndByItself()
        {
            HeldGamepad pad = HeldGamepad.Take("A pad");
            Window.Finish();
            var felt = new FeltPlayback { Device = FeltDevice.Gamepad };
            felt.Step(null);
            felt.Play(Window.Player!.PlayedSound!.Sound, 0, false);
            double seconds = 0.0;
            for (; felt.IsPlaying && seconds < 10.0; seconds += UpdateSeconds)
            {
                World.Frame(UpdateSeconds);
                felt.Step(null);
            }
            Assert.That(seconds, Is.EqualTo(Window.Player.PlayedSound.Sound.DurationSeconds).Within(0.05));
            World.Frame(UpdateSeconds);
            felt.Step(null);
            Assert.That(Strengths(pad).Last(), Is.Zero);
            felt.Close();
        }

        [TestCase(40.0, 1.0)]
        [TestCase(3000.0, 1.0)]
        [TestCase(5000.0, 0.0)]
        public void TheWaveForADeviceKeepsWhatItsRateCanHoldAndNothingElse(double frequencyHz, double gain)
        {
            float[] tone = Enumerable.Range(0, 48000)
                .Select(index => (float)(0.5 * Math.Sin(2.0 * Math.PI * frequencyHz * index / 48000.0))).ToArray();
            var wave = new SoundWave();
            wave.Play(Sound(tone), 0, false);
            var rendered = new float[8000];
            wave.Render(rendered.AsSpan(0, 77));
            wave.Render(rendered.AsSpan(77));
            IEnumerable<double> expected = Enumerable.Range(0, 8000).Select(index => gain * tone[6 * index]);
            Assert.That(rendered.Skip(100).Take(7800), Is.EqualTo(expected.Skip(100).Take(7800)).Within(0.005));
        }

        [Test]
        public void TheWaveFollowsTheSpeakersOnlyWhereItIsFarFromThem()
        {
            var wave = new SoundWave();
            wave.Play(Sound(new float[48000]), 12000, true);
            wave.Follow(12000 + 1400);
            Assert.That(wave.PositionSamples, Is.EqualTo(12000), "29 ms");
            wave.Follow(12000 + 9600);
            Assert.That(wave.PositionSamples, Is.EqualTo(21600), "200 ms");
            wave.Play(Sound(new float[48000]), 47800, true);
            wave.Follow(300);
            Assert.That(wave.PositionSamples, Is.EqualTo(47800), "over the seam of a loop");
            wave.Render(new float[100]);
            Assert.That(wave.PositionSamples, Is.EqualTo(400), "a loop goes on at the beginning");
            wave.Play(Sound(new float[48000]), 48000, false);
            Assert.That(wave.PositionSamples, Is.Zero, "past the end");
        }

        private static PreviewSound Sound(float[] samples) => new PreviewSound(new LabelMix("wood", "", 0f),
            PresetStrokes.Make(StrokePreset.Slide, new StrokeSettings(0.1f, 1f, 0f, 1f, 0.1f)), samples);

        private static IEnumerable<float> Strengths(HeldGamepad pad) => pad.Speeds.Select(each => each.Low + each.High);

        private HeldGamepad FeelPad()
        {
            State.Change("Device", state => state.FeltOn = FeltDevice.Gamepad);
            return HeldGamepad.Take("A pad");
        }

        private void Play(double seconds)
        {
            Window.Finish();
            Press("Play");
            Updates(seconds);
        }

        private string[] Remarks() => WindowHost.Draw(Window).Select(item => item.Label).ToArray();

        private void Updates(double seconds)
        {
            for (double passed = 0.0; passed < seconds - 1e-9; passed += UpdateSeconds)
            {
                World.Frame(UpdateSeconds);
                if (ClipPreview.Playing != null)
                {
                    ClipPreview.Advance((int)(PreviewSound.RateHz * UpdateSeconds));
                }
                Window.Step();
            }
        }
    }
}
