using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using HaptoFlow.Editor;
using HaptoFlow.Preview;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.PreviewTests
{
    /// <summary>Tests of the New Material window that need the shim: controls, dialogs, playback, clean-up.</summary>
    public sealed class NewMaterialScreenTests : NewMaterialTest
    {
        [SetUp]
        [TearDown]
        public void Reset()
        {
            Event.current = new Event { type = EventType.Repaint };
            WindowHost.AnswerToSave = null;
            WindowHost.AnswerToOpen = null;
        }

        private IReadOnlyList<Drawn> Screen() => WindowHost.Draw(Window);

        private Drawn Button(string caption) => Screen().Single(item => item.Kind == DrawnKind.Button && item.Label == caption);

        private void Press(string caption)
        {
            EditorScreen.Press(caption);
            Screen();
            WindowHost.Update();
        }

        private void Enter(string label, object value)
        {
            EditorScreen.Enter(label, value);
            Screen();
        }

        /// <summary>The recording of the Workshop sample as a .wav file with its sidecar files.</summary>
        private string Wave(bool withSidecar = true)
        {
            foreach (string name in withSidecar
                ? new[] { "doormat.wav", "doormat.json", "doormat.motion.csv" } : new[] { "doormat.wav" })
            {
                string stored = name == "doormat.wav" ? name + ".bytes" : name;
                File.Copy(Path.Combine(MadeRecordings.DoormatFolder, stored), Path.Combine(Folder, name));
            }
            return Path.Combine(Folder, "doormat.wav");
        }

        [Test]
        public void ButtonsAreDisabledUntilARecordingIsChosen()
        {
            IReadOnlyList<Drawn> drawn = Screen();
            foreach (string caption in new[] { "Learn", "Play", "Save as Haptic Material\u2026", "Export File\u2026" })
            {
                Assert.That(drawn.Single(item => item.Label == caption).Enabled, Is.False, caption);
            }
            Assert.That(drawn.Where(item => item.Kind == DrawnKind.Help).Single().Label, Does.StartWith("Choose a recording"));
        }

        [Test]
        public void EveryFieldChangesItsSettingWithUndo()
        {
            Window.Take(Wave(false));
            Window.Finish();
            ScreenFields.AssertChangedAndUndone(Window, new (string, object, Func<object>)[]
            {
                ("Speed [m/s]", 0.5f, () => State.SpeedMps),
                ("Force [N]", 2.5f, () => State.ForceNewtons),
                ("Full Scale [m/s\u00b2]", 13f, () => State.FullScaleMps2),
                ("Name", "mat", () => State.Name),
                ("Category", "cloth", () => State.Category),
                ("Licence", "MIT", () => State.Licence),
                ("Description", "A mat.", () => State.Description),
                ("Loop", true, () => State.Loops),
                ("Match Levels", true, () => State.MatchesLevels),
            });
        }

        [Test]
        public void AWavFileWithoutSidecarNeedsFullScaleSpeedAndForce()
        {
            WindowHost.AnswerToOpen = () => Wave(false);
            Press("Choose Recording\u2026");
            Window.Finish();
            Assert.That(Screen().Single(item => item.Value == "Error").Label, Does.Contain("no key 'full_scale_mps2'"));
            Enter("Full Scale [m/s\u00b2]", 13f);
            Window.Finish();
            Assert.That(Screen().Where(item => item.Value == "Error"), Is.Empty);
            Assert.That(Screen().Select(item => item.Label), Has.Some.StartsWith("Enter the speed and the force"));
            Enter("Speed [m/s]", 0.1f);
            Enter("Force [N]", 1f);
            Window.Finish();
            Assert.That(Button("Learn").Enabled, Is.True);
            Assert.That(Window.Session!.Recording!.VelocityAt(100).X, Is.EqualTo(0.1).Within(1e-7));
            Assert.That(Window.Session.Recording.ForceAt(100), Is.EqualTo(1.0));
        }

        [Test]
        public void AProgressBarReplacesTheLearnButtonDuringLearning()
        {
            Window.Take(Wave());
            Window.Finish();
            Assert.That(Screen().Where(item => item.Label == "Speed [m/s]" || item.Label == "Force [N]")
                .Select(item => item.Enabled), Is.EqualTo(new[] { false, false }), "the file's own values stay");
            Press("Learn");
            IReadOnlyList<Drawn> drawn = Screen();
            Assert.That(drawn.Count(item => item.Kind == DrawnKind.Bar), Is.EqualTo(1));
            Assert.That(drawn.Select(item => item.Label), Does.Not.Contain("Learn"));
            Press("Cancel");
            Window.Finish();
            Assert.That(Button("Learn").Enabled, Is.True);
            Assert.That(Screen().Where(item => item.Value == "Error"), Is.Empty, "cancelling is not an error");
        }

        [Test]
        public void ADomainReloadEndsLearningAndKeepsTheSettings()
        {
            Window.Take(Wave());
            Window.Finish();
            State.Change("Material", changed => changed.Material = Jute());
            Press("Learn");
            HapticLearning learning = Window.Session!.Learning!;
            WindowHost.Reload(Window);
            Assert.That(learning.IsCompleted, Is.True, "native code must not outlive a domain reload");
            Assert.That(Window.Session!.Learning, Is.Null);
            Assert.That((State.Name, State.Material), Is.EqualTo(("doormat", Jute())));
            Window.Finish();
            Assert.That(Window.Session.Shown!.Sounds, Has.Count.EqualTo(2));
        }

        [Test]
        public void AClosedWindowFreesTexturesAndClips()
        {
            int before = MediaCount.Alive;
            Window.Take(Wave());
            Window.Finish();
            Press("Play");
            Window.Step();
            Assert.That(ClipPreview.Playing, Is.Not.Null);
            Press("Learn");
            HapticLearning learning = Window.Session!.Learning!;
            WindowHost.Close(Window);
            Assert.That((learning.IsCompleted, MediaCount.Alive), Is.EqualTo((true, before)));
            Assert.That(ClipPreview.Playing, Is.Null);
            WindowHost.Update();
        }

        [Test]
        public void SwitchingBetweenRecordingAndResultKeepsThePosition()
        {
            Window.Take(Wave());
            State.Change("Material", changed => changed.Material = Jute());
            Window.Finish();
            Press("Play");
            Window.Step();
            AudioClip result = ClipPreview.Playing!;
            ClipPreview.Advance(9600);
            Press("Recording");
            Window.Finish();
            Assert.That(ClipPreview.Playing, Is.Not.Null.And.Not.SameAs(result));
            Assert.That(ClipPreview.Position, Is.EqualTo(9600));
            Press("Stop");
            Assert.That(ClipPreview.Playing, Is.Null);
        }

        [Test]
        public void CurvesReplaceTheSoundsWithUndoOnceAReportHasThem()
        {
            Window.Take(Wave());
            State.Change("Material", changed => changed.Material = Jute());
            Window.Finish();
            Assert.That(Button("Curves").Enabled, Is.False, "the material was not learnt here");
            State.Change("Report", changed => changed.Report = MadeReports.Of(6, 2, 1));
            Undo.IncrementCurrentGroup();
            Press("Curves");
            Assert.That(State.ShowsCurves, Is.True);
            string[] tips = Screen().Select(item => item.Tooltip).Where(tip => tip.Contains("learnt line")).ToArray();
            Assert.That(tips, Has.Length.EqualTo(2));
            Undo.PerformUndo();
            Assert.That(State.ShowsCurves, Is.False);
        }

        [Test]
        public void TheAssetAndTheExportedFileContainTheLearntMaterial()
        {
            Window.Take(Wave());
            State.Change("Material", changed =>
            {
                changed.Material = Jute();
                changed.Report = "{\"nearest_label\": \"jute\"}";
            });
            Window.Finish();
            WindowHost.AnswerToSave = name => "Assets/" + name;
            Press("Save as Haptic Material\u2026");
            WindowHost.Update();
            var saved = AssetDatabase.LoadAssetAtPath<HapticMaterial>("Assets/jute.asset");
            Assert.That((saved.Learnt, saved.Description.Label), Is.EqualTo((Jute(), "jute")));
            Assert.That(Selection.activeObject, Is.SameAs(saved));
            Press("Export File\u2026");
            WindowHost.Update();
            Assert.That(File.ReadAllText("Assets/jute.haptomaterial"), Is.EqualTo(Jute()));
            WindowHost.AnswerToSave = null;
            Press("Save as Haptic Material\u2026");
            Assert.That(State.Material, Is.EqualTo(Jute()), "a cancelled dialog changes nothing");
        }
    }
}
