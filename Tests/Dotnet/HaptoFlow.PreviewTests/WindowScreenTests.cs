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
    /// <summary>Tests of the Texture Preview window that need the shim: drawing, controls, clean-up.</summary>
    public sealed class WindowScreenTests : PreviewWindowTest
    {
        private void Enter(string label, object value)
        {
            EditorScreen.Enter(label, value);
            Screen();
        }

        /// <summary>Colour of the first shape of the charts, the card behind them.</summary>
        private Color CardColour()
        {
            Screen();
            float left = (float)new PreviewLayout(Window.position.width, Window.position.height).Charts.Left;
            return ScreenPaint.All.First(each => each.Place.x == left).Color;
        }

        private static Texture2D[] Images() =>
            ScreenPaint.All.Select(each => each.Image)
                .Where(image => image != null && image.name != "UnityWhite").ToArray()!;

        [SetUp]
        public void Reset()
        {
            Event.current = new Event { type = EventType.Repaint };
            EditorSession.DarkSkin = true;
            WindowHost.PixelsPerPoint = 1f;
        }

        [Test]
        public void EveryControlChangesItsSettingWithUndo()
        {
            State.Compares = true;
            Window.Finish();
            ScreenFields.AssertChangedAndUndone(Window, new (string, object, Func<object>)[]
            {
                ("Stroke", (int)StrokePreset.Taps, () => (int)State.Preset),
                ("Speed [m/s]", 0.5f, () => State.SpeedMps),
                ("Force [N]", 2.5f, () => State.ForceNewtons),
                ("Direction [\u00b0]", 90f, () => State.DirectionDegrees),
                ("Contact [s]", 0.5f, () => State.ContactSeconds),
                ("Compare", false, () => State.Compares),
                ("Landing [m/s]", 1f, () => State.LandingMps),
                ("Texture", false, () => State.HasTexture),
                ("Impact", false, () => State.HasImpact),
                ("Edge", false, () => State.HasEdge),
                ("Device", (int)PreviewDevice.Motor, () => (int)State.Device),
                ("Seed", 7, () => State.Seed),
                ("Loop", true, () => State.Loops),
                ("Normalise", false, () => State.Raises),
            });
        }

        [Test]
        public void UnfoldedSlidersChangeTheMaterialAndReset()
        {
            Window.Finish();
            Assert.That(Screen().Select(item => item.Label), Does.Not.Contain("Coarseness"));
            Enter("Sliders", true);
            Drawn reset = Screen().Single(item => item.Label == "Reset");
            Assert.That(reset.Enabled, Is.False, "nothing was changed");
            Undo.IncrementCurrentGroup();
            Enter("Coarseness", 0.5f);
            Assert.That(State.First.Moves, Is.EqualTo(new[] { 0.5f, 0f, 0f, 0f, 0f }));
            Enter("Level", -5f);
            Assert.That(State.First.Moves[4], Is.EqualTo(-1f), "limited to the range of the slider");
            Undo.IncrementCurrentGroup();
            Press("Reset");
            Assert.That(State.First.Moves, Is.Empty);
            Undo.PerformUndo();
            Assert.That(State.First.Moves, Is.EqualTo(new[] { 0.5f, 0f, 0f, 0f, -1f }));
        }

        [Test]
        public void FeatureScaleAndToneSlidersChangeTheSoundWithinTheirRanges()
        {
            Window.Finish();
            float[] before = Samples;
            Assert.That(Screen().Select(item => item.Label), Does.Not.Contain("Feature Scale"));
            Enter("Sliders", true);
            Undo.IncrementCurrentGroup();
            Enter("Feature Scale", 9f);
            Assert.That(State.First.FeatureScale, Is.EqualTo(4f));
            Undo.IncrementCurrentGroup();
            Enter("Tone [dB/oct]", -40f);
            Assert.That(State.First.ToneDbPerOctave, Is.EqualTo(-12f));
            Window.Finish();
            Assert.That(Window.Player!.PlayedSound!.Sound.Title, Is.EqualTo("wood (x4, -12 dB/oct)"));
            Assert.That(Samples.SequenceEqual(before), Is.False);
            Undo.PerformUndo();
            Assert.That((State.First.FeatureScale, State.First.ToneDbPerOctave), Is.EqualTo((4f, 0f)));
            Undo.PerformUndo();
            Assert.That(State.First.FeatureScale, Is.EqualTo(1f));
            Window.Finish();
            Assert.That(Samples.SequenceEqual(before), Is.True);
        }

        [Test]
        public void AChangedMaterialIsSavedWithFeatureScaleAndToneAndPreviewedFromThenOn()
        {
            WindowHost.AnswerToSave = name => "Assets/" + name;
            Enter("Sliders", true);
            Assert.That(Screen().Single(item => item.Label == "Save as Haptic Material\u2026").Enabled, Is.False);
            Enter("Hardness", -0.5f);
            Enter("Feature Scale", 2f);
            Enter("Tone [dB/oct]", 3f);
            Window.Finish();
            float[] moved = Samples;
            Press("Save as Haptic Material\u2026");
            WindowHost.Update();
            Assert.That(WindowHost.Notification, Is.EqualTo("Saved wood, moved"));
            var saved = AssetDatabase.LoadAssetAtPath<HapticMaterial>("Assets/wood, moved.asset");
            Assert.That((saved.IsLearnt, saved.Description.FeatureScale, saved.Description.ToneDbPerOctave),
                Is.EqualTo((true, 2f, 3f)));
            Assert.That((State.First.Learnt, State.First.FeatureScale, State.First.Moves.Length),
                Is.EqualTo((saved, 2f, 0)));
            Window.Finish();
            Assert.That(Samples.SequenceEqual(moved), Is.True);
            WindowHost.AnswerToSave = null;
        }

        [Test]
        public void SecondMaterialAndShareAppearAtTheNextLayout()
        {
            Window.Finish();
            Assert.That(Screen().Single(item => item.Label == "B").Enabled, Is.False);
            Enter("Compare", true);
            Assert.That(Screen().Select(item => item.Label), Does.Contain("Material B").And.Not.Contain("Share"));
            Assert.That(Screen().Single(item => item.Label == "B").Enabled, Is.True);
            State.First.SecondLabel = "cork";
            Assert.That(Screen().Count(item => item.Label == "Share"), Is.EqualTo(1));
            Enter("Compare", false);
            Assert.That(Screen().Select(item => item.Label), Does.Not.Contain("Material B"));
        }

        [Test]
        public void TheApplyButtonAssignsTheActiveMaterialWithUndo()
        {
            HapticSurface table = Make("Table").AddComponent<HapticSurface>();
            table.Material.Label = "stone";
            Selection.activeObject = table.gameObject;
            State.Compares = true;
            State.Active = 1;
            Window.Finish();
            Press("Apply to Selection");
            Assert.That(table.Material.Label, Is.EqualTo("sandpaper"));
            Assert.That(WindowHost.Notification, Is.EqualTo("Applied sandpaper to Table"));
            Undo.PerformUndo();
            Assert.That(table.Material.Label, Is.EqualTo("stone"));
            Press("Take from Selection");
            Assert.That(State.Second.Label, Is.EqualTo("stone"));
            Assert.That(State.First.Label, Is.EqualTo("wood"));
        }

        [Test]
        public void ADroppedHapticMaterialIsPreviewed()
        {
            HapticMaterial asset = Keep(ScriptableObject.CreateInstance<HapticMaterial>());
            asset.Description.Label = "leather";
            asset.Description.SecondLabel = "cork";
            asset.Description.Blend = 0.75f;
            Window.Finish();
            Enter("Take from", asset);
            Assert.That(State.Mixes(new string[0])[0], Is.EqualTo(new LabelMix("leather", "cork", 0.75f)));
            Assert.That(Screen().Single(item => item.Label == "Take from").Value, Does.Not.Contain("leather"));
        }

        [Test]
        public void AReliefIsChosenWithUndoAndItsChangesAreFollowed()
        {
            Window.Finish();
            float[] even = Samples;
            HapticRelief relief = Relief();
            Undo.IncrementCurrentGroup();
            Enter("Relief", relief);
            Window.Finish();
            float[] first = Samples;
            Assert.That(first.SequenceEqual(even), Is.False);
            Assert.That(Window.Session!.Shown!.Heights!.DepthMillimetres, Is.EqualTo(1.0).Within(1e-4));
            Window.Step();
            Assert.That(Window.Session.IsBusy, Is.False, "nothing has changed");
            relief.SetHeights(2, 1, new[] { 1f, 0f });
            Window.Step();
            Assert.That(Window.Session.IsBusy, Is.True, "a script replaced the map");
            Window.Finish();
            Assert.That(Samples.SequenceEqual(first), Is.False);
            relief.Share = 0.1f;
            Window.Step();
            Assert.That(Window.Session.IsBusy, Is.True, "the share");
            Undo.PerformUndo();
            Assert.That(State.Relief == null, Is.True);
            Window.Finish();
            Assert.That(Samples, Is.EqualTo(even));
        }

        [Test]
        public void AReliefWithoutHeightsIsEvenAndSaysSo()
        {
            Window.Finish();
            float[] even = Samples;
            HapticRelief relief = Keep(ScriptableObject.CreateInstance<HapticRelief>());
            relief.name = "Waves";
            State.Change("Relief", state => state.Relief = relief);
            Window.Finish();
            Assert.That(Samples, Is.EqualTo(even));
            Drawn help = Screen().Single(item => item.Kind == DrawnKind.Help);
            Assert.That((help.Label, help.Value),
                Is.EqualTo(("Waves has no heights: the stroke goes over an even surface.", "Info")));
        }

        [Test]
        public void AReliefThatIsDestroyedIsNoneAndAReloadKeepsTheOthers()
        {
            HapticRelief relief = Relief();
            State.Change("Relief", state => state.Relief = relief);
            Window.Finish();
            float[] first = Samples;
            WindowHost.Reload(Window);
            WindowHost.Update();
            Window.Finish();
            Assert.That(Window.Session!.Shown!.Heights, Is.Not.Null);
            Assert.That(Samples, Is.EqualTo(first));
            UnityEngine.Object.DestroyImmediate(relief);
            Window.Finish();
            Assert.That(Window.Session.Shown!.Heights, Is.Null);
            Assert.That(Samples.SequenceEqual(first), Is.False);
            Screen();
        }

        [Test]
        public void AnObjectsReliefComesAlongWithItsMaterialInOneUndo()
        {
            HapticSurface wall = Make("Wall").AddComponent<HapticSurface>();
            wall.Material.Label = "stone";
            wall.Relief = Relief();
            Selection.activeObject = wall.gameObject;
            Window.Finish();
            Undo.IncrementCurrentGroup();
            Press("Take from Selection");
            Assert.That((State.First.Label, State.Relief), Is.EqualTo(("stone", wall.Relief)));
            Assert.That(WindowHost.Notification, Is.EqualTo("Took stone from Wall with its relief Waves"));
            Undo.PerformUndo();
            Assert.That((State.First.Label, State.Relief == null), Is.EqualTo(("wood", true)));
            TexturePreviewWindow.Open(wall);
            Assert.That(State.Relief, Is.SameAs(wall.Relief));
            HapticMaterial asset = Keep(ScriptableObject.CreateInstance<HapticMaterial>());
            Enter("Take from", asset);
            Selection.activeObject = asset;
            Press("Take from Selection");
            TexturePreviewWindow.Open(asset);
            Assert.That(State.Relief, Is.SameAs(wall.Relief), "a material has none, and takes none away");
            Selection.activeObject = wall.gameObject;
            wall.Relief = null;
            Press("Take from Selection");
            Assert.That(State.Relief == null, Is.True, "the even wall is previewed");
        }

        [Test]
        public void ThePositionOfPlaybackIsMarkedInTheHeightToo()
        {
            State.Change("Relief", state => state.Relief = Relief());
            Window.Finish();
            Press("Play");
            Window.Step();
            Screen();
            Box charts = new PreviewLayout(Window.position.width, Window.position.height).Charts;
            IEnumerable<Rect> expected = Window.Session!.Shown!.Panel.Plots(charts, 0)
                .Select(plot => plot.Columns(0.0, 1.0).ToRect());
            Assert.That(expected.Count(), Is.EqualTo(3));
            foreach (Rect line in expected)
            {
                Assert.That(ScreenPaint.All.Count(each => each.Color.Equals(Palette.Dark.Ink.ToColor()) &&
                    (each.Place.width, each.Place.y, each.Place.height) == (1f, line.y, line.height)), Is.EqualTo(1));
            }
        }

        private HapticRelief Relief()
        {
            HapticRelief relief = Keep(ScriptableObject.CreateInstance<HapticRelief>());
            relief.name = "Waves";
            relief.SizeMetres = new Vector2(0.01f, 0.01f);
            relief.SetHeights(4, 1, new[] { 0f, 1f, 1f, 0f });
            return relief;
        }

        [Test]
        public void TheQualityListHasTheTiersOfTheModel()
        {
            Window.Finish();
            Enter("Quality", 0);
            Assert.That(State.Tier, Is.EqualTo("sketch"));
            Assert.That(Screen().Single(item => item.Label == "Quality").Value, Is.EqualTo("sketch"));
            State.Tier = "exquisite";
            Assert.That(Screen().Single(item => item.Label == "Quality").Value, Is.EqualTo("standard"), "the default");
        }

        [Test]
        public void AProblemIsShownInAHelpBox()
        {
            State.First.Label = "granite";
            Window.Finish();
            Drawn help = Screen().Single(item => item.Kind == DrawnKind.Help);
            Assert.That(help.Label, Does.Contain("granite"));
            Assert.That(help.Value, Is.EqualTo("Error"));
        }

        [Test]
        public void ChartsAreDrawnInTheSkinAndThePixelsOfTheEditor()
        {
            Window.Finish();
            Assert.That(CardColour(), Is.EqualTo(Palette.Dark.Card.ToColor()));
            EditorSession.DarkSkin = false;
            Assert.That(CardColour(), Is.EqualTo(Palette.Light.Card.ToColor()));
            WindowHost.PixelsPerPoint = 2f;
            Screen();
            float thinnest = ScreenPaint.All.Where(each => each.Call == "DrawRect").Min(each => each.Place.height);
            Assert.That(thinnest, Is.EqualTo(0.5f), "a hairline is one pixel");
        }

        [Test]
        public void KeysOfOthersAndOfTextAreIgnored()
        {
            Assert.That(Key(KeyCode.E), Is.False);
            Assert.That(Key(KeyCode.A, EventModifiers.Alt), Is.False);
            EditorGUIUtility.editingTextField = true;
            Assert.That(Key(KeyCode.Space), Is.False);
            Assert.That(Key(KeyCode.RightArrow), Is.False);
            Assert.That(State.SpeedMps, Is.EqualTo(0.12f));
        }

        [Test]
        public void AClosedWindowFreesTexturesAndClips()
        {
            int before = MediaCount.Alive;
            Window.Finish();
            Screen();
            Key(KeyCode.Space);
            Window.Step();
            Assert.That(MediaCount.Alive, Is.EqualTo(before + 3), "the spectrogram, its legend and a clip");
            Close();
            Assert.That(MediaCount.Alive, Is.EqualTo(before));
            Assert.That(ClipPreview.Playing, Is.Null);
            WindowHost.Update();
        }

        [Test]
        public void TheWindowWorksAfterADomainReload()
        {
            int before = MediaCount.Alive;
            Window.Finish();
            float[] wood = Samples;
            PreviewSession old = Window.Session!;
            State.Change("Seed", state => state.Seed = 5);
            Window.Step();
            Assert.That(old.IsBusy, Is.True, "the reload happens during rendering");
            WindowHost.Reload(Window);
            Assert.That(old.IsBusy, Is.False);
            Assert.That(Window.Session, Is.Not.SameAs(old));
            Assert.That(MediaCount.Alive, Is.EqualTo(before));
            Assert.That(State.Seed, Is.EqualTo(5), "settings survive");
            WindowHost.Update();
            Window.Finish();
            Assert.That(Samples, Is.Not.EqualTo(wood));
        }

        [Test]
        public void TexturesAreReplacedOnlyWhenTheSoundChanges()
        {
            Window.Finish();
            Screen();
            int textures = MediaCount.Alive;
            Texture2D[] first = Images();
            Screen();
            Window.position = new Rect(0f, 0f, 1500f, 900f);
            Screen();
            Assert.That(Images(), Is.EqualTo(first), "textures do not depend on the size");
            State.Change("Seed", state => state.Seed = 2);
            Window.Finish();
            Screen();
            Assert.That(MediaCount.Alive, Is.EqualTo(textures));
            Assert.That(Images(), Is.Not.EqualTo(first));
        }

        [Test]
        public void ARepaintWithoutChangesReplaysTheSameDrawingWithoutGarbage()
        {
            Window.Finish();
            Screen();
            PreviewView view = PreviewView.Of(Window.position, PreviewRoom.Default, null);
            int drawings = 0;
            var picture = new EditorPicture(canvas =>
            {
                ++drawings;
                Window.Session!.Shown!.Panel.Draw(canvas, view.Palette, view.Layout.Charts, 0);
            });
            Event.current = new Event { type = EventType.Layout };
            picture.OnGUI(this, view);
            Assert.That(drawings, Is.Zero, "only a repaint draws");
            Event.current = new Event { type = EventType.Repaint };
            picture.OnGUI(this, view);
            ScreenPaint.Clear();
            picture.OnGUI(this, view);
            int calls = ScreenPaint.All.Count;
            ScreenPaint.Clear();
            long before = GC.GetAllocatedBytesForCurrentThread();
            picture.OnGUI(this, view);
            Assert.That(GC.GetAllocatedBytesForCurrentThread() - before, Is.Zero);
            Assert.That((drawings, ScreenPaint.All.Count), Is.EqualTo((1, calls)));
            picture.Release();
        }

        [Test]
        public void TheTiersOfAnImportedModelSoundDifferentAndItHasNoSliders()
        {
            HapticModelAsset model = HapticModelAsset.Create(
                File.ReadAllBytes(RepositoryFiles.In("Tests", "Golden", "model", "published.haptoflow")));
            State.Model = model;
            State.First.Label = "wool felt";
            var sounds = new List<float[]>();
            foreach (string tier in PreviewModel.Of(model).Tiers.ToArray())
            {
                State.Change("Quality", state => state.Tier = tier);
                Window.Finish();
                Assert.That(Window.Session!.Problem, Is.Null);
                Assert.That(Samples.Max(Math.Abs), Is.GreaterThan(1e-4f), tier);
                sounds.Add(Samples);
            }
            Assert.That(sounds, Has.Count.EqualTo(2).And.Unique);
            EditorScreen.Enter("Sliders", true);
            WindowHost.Draw(Window);
            string[] shown = WindowHost.Draw(Window).Select(item => item.Label).ToArray();
            Assert.That(shown, Has.Member("Feature Scale").And.Some.StartsWith("This model has no sliders"));
        }
    }

    internal static class ScreenFields
    {
        /// <summary>Asserts that a value entered in a field of a window is kept, and that undo restores the one before.
        /// </summary>
        public static void AssertChangedAndUndone(
            EditorWindow window, IEnumerable<(string Label, object Value, Func<object> Kept)> fields)
        {
            foreach ((string label, object value, Func<object> kept) in fields)
            {
                object before = kept();
                Undo.IncrementCurrentGroup();
                EditorScreen.Enter(label, value);
                WindowHost.Draw(window);
                Assert.That(kept(), Is.EqualTo(value), label);
                Undo.PerformUndo();
                Assert.That(kept(), Is.EqualTo(before), label);
            }
        }
    }

    /// <summary>Tests of the Texture Preview window that need the shim: playback and export.</summary>
    public sealed class WindowSoundTests : PreviewWindowTest
    {
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
            Assert.That(File.ReadAllBytes(path), Is.EqualTo(WaveFile.Bytes(Samples, 48000)));
            Assert.That(WindowHost.Notification, Is.EqualTo("Exported"));
        }

        [TestCase(SoundFormat.Haptic)]
        [TestCase(SoundFormat.Ahap)]
        [TestCase(SoundFormat.Hjif)]
        public void AClipIsExportedWithItsMaterialAndHowItWasMade(object chosen)
        {
            var format = (SoundFormat)chosen;
            string ending = SoundExport.Endings[(int)format];
            string path = TemporaryFile() + ending;
            string proposed = "";
            WindowHost.AnswerToSave = name =>
            {
                proposed = name;
                return path;
            };
            State.Change("Format", state => state.ExportAs = format);
            Press("Export\u2026");
            WindowHost.Update();
            Assert.That(WindowHost.Notification, Is.EqualTo("Exported"));
            Assert.That(proposed, Is.EqualTo("wood 0.12 mps 1.5 N" + ending));
            using HapticClipFile clip = HapticClipFile.Read(File.ReadAllBytes(path));
            Assert.That(clip.Info.Format, Is.EqualTo((HapticClipFormat)((int)format - 1)));
            Assert.That(clip.Info.DurationSeconds, Is.EqualTo(Samples.Length / 48000.0).Within(0.02));
            Assert.That(clip.Info.LargestAmplitude, Is.GreaterThan(0.05f));
            Assert.That(clip.Info.Title + clip.Info.Description, Does.Contain("wood")
                .And.Contain("slide, 0.12 m/s, 1.5 N; model default, draft, seed 1"));
        }

        [Test]
        public void AClipIsOfTheMaterialAlsoWhereADeviceIsShown()
        {
            string direct = TemporaryFile() + ".haptic";
            Assert.That(Window.ExportTo(direct), Is.Null);
            State.Change("Device", state => (state.Device, state.Active) = (PreviewDevice.Motor, 1));
            string shown = TemporaryFile() + ".haptic";
            Assert.That(Window.ExportTo(shown), Is.Null);
            Assert.That(File.ReadAllText(shown), Is.EqualTo(File.ReadAllText(direct)));
        }

        [Test]
        public void AnEndingThatNamesNoFormatIsRefused()
        {
            string path = TemporaryFile() + ".mp3";
            Assert.That(Window.ExportTo(path), Does.Contain(".mp3").And.Contain(".wav, .haptic, .ahap, .hjif"));
            Assert.That(File.Exists(path), Is.False);
        }
    }
}
