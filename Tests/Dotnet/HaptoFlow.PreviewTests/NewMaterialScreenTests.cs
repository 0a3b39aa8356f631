using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using HaptoFlow.Editor;
using HaptoFlow.Model;
using HaptoFlow.Preview;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.PreviewTests
{
    /// <summary>Tests of the New Material window that need the shim: controls, dialogs, playback, clean-up.</summary>
    public sealed class NewMaterialScreenTests
    {
        private NewMaterialWindow window = null!;

        private NewMaterialState State => window.State;

        [SetUp]
        public void OpenWindow()
        {
            EditorSession.Begin(RepositoryFiles.In("Packages", "com.haptoflow.runtime"));
            Event.current = new Event { type = EventType.Repaint };
            WindowHost.AnswerToSave = null;
            WindowHost.AnswerToOpen = null;
            NewMaterialWindow.Open();
            window = EditorWindow.GetWindow<NewMaterialWindow>();
        }

        [TearDown]
        public void CloseWindow()
        {
            if (window != null)
            {
                WindowHost.Close(window);
            }
            EditorSession.End();
            WindowHost.AnswerToSave = null;
            WindowHost.AnswerToOpen = null;
        }

        private IReadOnlyList<Drawn> Screen() => WindowHost.Draw(window);

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

        private static string Doormat() => Path.Combine(MadeRecordings.DoormatFolder, "doormat.wav.bytes");

        /// <summary>The recording of the Workshop sample as a .wav file with its sidecar files.</summary>
        private static string Wave(bool withSidecar = true)
        {
            string folder = Path.Combine(Environment.CurrentDirectory, "Recordings");
            Directory.CreateDirectory(folder);
            File.Copy(Doormat(), Path.Combine(folder, "doormat.wav"), true);
            foreach (string name in new[] { "doormat.json", "doormat.motion.csv" }.Where(_ => withSidecar))
            {
                File.Copy(Path.Combine(Path.GetDirectoryName(Doormat())!, name), Path.Combine(folder, name), true);
            }
            return Path.Combine(folder, "doormat.wav");
        }

        private static string Text() => MaterialText.OfLabel(ProjectSettingsAsset.DefaultModel()!.File, "jute");

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
            window.Take(Wave(false));
            window.Finish();
            var cases = new (string Label, object Value, Func<object> Kept)[]
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
            };
            foreach ((string label, object value, Func<object> kept) in cases)
            {
                object before = kept();
                Undo.IncrementCurrentGroup();
                Enter(label, value);
                Assert.That(kept(), Is.EqualTo(value), label);
                Undo.PerformUndo();
                Assert.That(kept(), Is.EqualTo(before), label);
            }
        }

        [Test]
        public void AWavFileWithoutSidecarNeedsFullScaleSpeedAndForce()
        {
            WindowHost.AnswerToOpen = () => Wave(false);
            Press("Choose Recording\u2026");
            window.Finish();
            Assert.That(Screen().Single(item => item.Value == "Error").Label, Does.Contain("no key 'full_scale_mps2'"));
            Enter("Full Scale [m/s\u00b2]", 13f);
            window.Finish();
            Assert.That(Screen().Where(item => item.Value == "Error"), Is.Empty);
            Assert.That(Screen().Select(item => item.Label), Has.Some.StartsWith("Enter the speed and the force"));
            Enter("Speed [m/s]", 0.1f);
            Enter("Force [N]", 1f);
            window.Finish();
            Assert.That(Button("Learn").Enabled, Is.True);
            Assert.That(window.Session!.Recording!.VelocityAt(100).X, Is.EqualTo(0.1).Within(1e-7));
            Assert.That(window.Session.Recording.ForceAt(100), Is.EqualTo(1.0));
        }

        [Test]
        public void AProgressBarReplacesTheLearnButtonDuringLearning()
        {
            window.Take(Wave());
            window.Finish();
            Assert.That(Screen().Where(item => item.Label == "Speed [m/s]" || item.Label == "Force [N]")
                .Select(item => item.Enabled), Is.EqualTo(new[] { false, false }), "the file's own values stay");
            Press("Learn");
            IReadOnlyList<Drawn> drawn = Screen();
            Assert.That(drawn.Count(item => item.Kind == DrawnKind.Bar), Is.EqualTo(1));
            Assert.That(drawn.Select(item => item.Label), Does.Not.Contain("Learn"));
            Press("Cancel");
            window.Finish();
            Assert.That(Button("Learn").Enabled, Is.True);
            Assert.That(Screen().Where(item => item.Value == "Error"), Is.Empty, "cancelling is not an error");
        }

        [Test]
        public void ADomainReloadEndsLearningAndKeepsTheSettings()
        {
            window.Take(Wave());
            window.Finish();
            State.Change("Material", changed => changed.Material = Text());
            Press("Learn");
            HapticLearning learning = window.Session!.Learning!;
            WindowHost.Reload(window);
            Assert.That(learning.IsCompleted, Is.True, "native code must not outlive a domain reload");
            Assert.That(window.Session!.Learning, Is.Null);
            Assert.That((State.Name, State.Material), Is.EqualTo(("doormat", Text())));
            window.Finish();
            Assert.That(window.Session.Shown!.Sounds, Has.Count.EqualTo(2));
        }

        [Test]
        public void AClosedWindowFreesTexturesAndClips()
        {
            int before = MediaCount.Alive;
            window.Take(Wave());
            window.Finish();
            Press("Play");
            window.Step();
            Assert.That(ClipPreview.Playing, Is.Not.Null);
            Press("Learn");
            HapticLearning learning = window.Session!.Learning!;
            WindowHost.Close(window);
            window = null!;
            Assert.That((learning.IsCompleted, MediaCount.Alive), Is.EqualTo((true, before)));
            Assert.That(ClipPreview.Playing, Is.Null);
            WindowHost.Update();
        }

        [Test]
        public void SwitchingBetweenRecordingAndResultKeepsThePosition()
        {
            window.Take(Wave());
            State.Change("Material", changed => changed.Material = Text());
            window.Finish();
            Press("Play");
            window.Step();
            AudioClip result = ClipPreview.Playing!;
            ClipPreview.Advance(9600);
            Press("Recording");
            window.Finish();
            Assert.That(ClipPreview.Playing, Is.Not.Null.And.Not.SameAs(result));
            Assert.That(ClipPreview.Position, Is.EqualTo(9600));
            Press("Stop");
            Assert.That(ClipPreview.Playing, Is.Null);
        }

        [Test]
        public void CurvesReplaceTheSoundsWithUndoOnceAReportHasThem()
        {
            window.Take(Wave());
            State.Change("Material", changed => changed.Material = Text());
            window.Finish();
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
            window.Take(Wave());
            State.Change("Material", changed =>
            {
                changed.Material = Text();
                changed.Report = "{\"nearest_label\": \"jute\"}";
            });
            window.Finish();
            WindowHost.AnswerToSave = name => "Assets/" + name;
            Press("Save as Haptic Material\u2026");
            WindowHost.Update();
            var saved = AssetDatabase.LoadAssetAtPath<HapticMaterial>("Assets/jute.asset");
            Assert.That((saved.Learnt, saved.Description.Label), Is.EqualTo((Text(), "jute")));
            Assert.That(Selection.activeObject, Is.SameAs(saved));
            Press("Export File\u2026");
            WindowHost.Update();
            Assert.That(File.ReadAllText("Assets/jute.haptomaterial"), Is.EqualTo(Text()));
            WindowHost.AnswerToSave = null;
            Press("Save as Haptic Material\u2026");
            Assert.That(State.Material, Is.EqualTo(Text()), "a cancelled dialog changes nothing");
        }
    }
}
