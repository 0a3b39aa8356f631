using System;
using System.IO;
using System.Linq;
using HaptoFlow.Preview;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.PreviewTests
{
    /// <summary>Tests of the Texture Preview window that need the shim: playback and export.</summary>
    public sealed class WindowSoundTests : PreviewWindowTest
    {
        private void Press(string caption)
        {
            EditorScreen.Press(caption);
            WindowHost.Draw(Window);
        }

        [SetUp]
        public void Reset() => WindowHost.AnswerToSave = null;

        [Test]
        public void PlayStartsTheNormalisedActiveSoundAndStopEndsIt()
        {
            Window.Finish();
            Press("Play");
            Window.Step();
            AudioClip clip = ClipPreview.Playing!;
            var played = new float[clip.samples];
            clip.GetData(played, 0);
            Assert.That((clip.frequency, clip.channels), Is.EqualTo((48000, 1)));
            Assert.That(played.Max(sample => Math.Abs(sample)), Is.EqualTo(0.9f).Within(1e-4f));
            float gain = Window.Player!.Gain;
            Assert.That(played, Is.EqualTo(Samples.Select(sample => gain * sample)).Within(1e-6f));
            Press("Stop");
            Assert.That(ClipPreview.Playing, Is.Null);
            Assert.That(Window.Player.PlayedSeconds, Is.Null);
            State.Change("Normalise", state => state.Raises = false);
            Window.Finish();
            Press("Play");
            Window.Step();
            ClipPreview.Playing!.GetData(played, 0);
            Assert.That(played, Is.EqualTo(Samples));
        }

        [Test]
        public void BothMaterialsAreNormalisedWithTheSameGain()
        {
            State.Compares = true;
            Window.Finish();
            float gain = Window.Player!.Gain;
            State.Change("Material", state => state.Active = 1);
            Window.Finish();
            Assert.That(Window.Player.Gain, Is.EqualTo(gain));
            float loudest = Window.Session!.Shown!.Sounds.Max(sound => sound.Sound.Peak);
            Assert.That(gain * loudest, Is.EqualTo(0.9f).Within(1e-4f));
        }

        [Test]
        public void SwitchingMaterialsDuringPlaybackKeepsThePosition()
        {
            State.Compares = true;
            Window.Finish();
            Key(KeyCode.Space);
            Window.Step();
            AudioClip first = ClipPreview.Playing!;
            ClipPreview.Advance(9600);
            Press("B");
            Window.Finish();
            Assert.That(ClipPreview.Playing, Is.Not.Null.And.Not.SameAs(first));
            Assert.That(ClipPreview.Position, Is.EqualTo(9600));
            Assert.That(Window.Player!.PlayedSeconds, Is.EqualTo(0.2).Within(1e-9));
        }

        [Test]
        public void PlaybackStopsAtTheEndUnlessItLoops()
        {
            Window.Finish();
            Key(KeyCode.Space);
            Window.Step();
            ClipPreview.Advance(10 * 48000);
            Window.Step();
            Assert.That(Window.Player!.IsPlaying, Is.False);
            State.Loops = true;
            Key(KeyCode.Space);
            Window.Step();
            ClipPreview.Advance(10 * 48000);
            Window.Step();
            Assert.That(Window.Player.IsPlaying, Is.True);
        }

        [Test]
        public void ExportProposesAFileNameFromMaterialAndStroke()
        {
            string proposed = "";
            string path = TemporaryFile();
            WindowHost.AnswerToSave = name =>
            {
                proposed = name;
                return path;
            };
            Assert.That(Key(KeyCode.E, EventModifiers.Control), Is.True);
            Assert.That(proposed, Is.Empty, "the dialog opens after the event");
            WindowHost.Update();
            Assert.That(proposed, Is.EqualTo("wood 0.12 mps 1.5 N.wav"));
            Assert.That(new WaveReader(File.ReadAllBytes(path)).Samples(), Is.EqualTo(Samples));
            Assert.That(WindowHost.Notification, Is.EqualTo("Exported"));
        }
    }
}
