using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.EditorTests
{
    /// <summary>Play mode in an editor with domain reload off, and reloads of scripts.</summary>
    public sealed class PlayModeTests : PlayedTest
    {
        [Test]
        public void PlayModeUsesTheProjectsSettings()
        {
            HaptoFlowSettings settings = Settings();
            for (int round = 0; round < 2; ++round)
            {
                EditorSession.Play();
                Assert.That(HaptoFlowSettings.Active, Is.SameAs(settings));
                HaptoFlowSettings.Active = ScriptableObject.CreateInstance<HaptoFlowSettings>();
                EditorSession.Stop();
                Assert.That(HaptoFlowSettings.Active, Is.SameAs(settings),
                    "the settings of a script apply to one play mode only");
            }
        }

        [Test]
        public void WithoutSettingsThePackagesModelPlaysAndOneMessageIsLogged()
        {
            // The quality is then automatic, which needs a worker.
            HapticSession.OptionsOverride = null;
            Stylus();
            EditorSession.Play();
            Assert.That(HaptoFlowSettings.Active.Model, Is.SameAs(Model()));
            World.Frames(3);
            Assert.That(LogLines("built-in"), Has.Length.EqualTo(1));
            Assert.That(AssetDatabase.FindAssets("t:HaptoFlowSettings"), Is.Empty, "play mode creates no asset");
        }

        [TestCase("reload")]
        [TestCase("quit")]
        [TestCase("stop")]
        public void TheEngineEndsBeforeScriptsReloadAndPlayModeEnds(string end)
        {
            HapticEngine engine = PlayWithEngine();
            switch (end)
            {
                case "reload":
                    EditorSession.ReloadScripts();
                    break;
                case "quit":
                    EditorSession.Quit();
                    break;
                default:
                    EditorSession.Stop();
                    break;
            }
            Assert.That(HapticSession.Existing, Is.Null);
            Assert.Throws<HaptoFlowException>(() => engine.Statistics());
        }

        [Test]
        public void AStylusShowsWhatItTouches()
        {
            HapticStylus stylus = PlayTouching(out _);
            Drawn[] drawn = InspectorTests.Draw(stylus).ToArray();
            Assert.That(Value(drawn, "Touches"), Is.EqualTo("Table"));
            Assert.That(Value(drawn, "Feels like"), Is.EqualTo("wood"));
            Assert.That(Value(drawn, "Because of"), Is.EqualTo("Haptic Surface on \"Table\""));
            Assert.That(Value(drawn, "Force"), Does.EndWith(" N"));
            Assert.That(Value(drawn, "Penetration"), Is.EqualTo("1.0 mm"));
            Assert.That(Value(drawn, "Underruns"), Is.EqualTo("0"));
            Assert.That(Value(drawn, "Silence"), Is.EqualTo("none: it plays").Or.StartsWith("rest"));
            stylus.transform.position = new Vector3(0f, 1f, 0f);
            World.Frames(3);
            Assert.That(Value(InspectorTests.Draw(stylus), "Touches"), Is.EqualTo("nothing"));
        }

        [Test]
        public void ALabelChosenInPlayModeIsFelt()
        {
            HapticStylus stylus = PlayTouching(out _);
            HapticSurface surface = stylus.Contact.Surface!;
            LabelBlend before = surface.LookUp(HapticSession.Current).Labels;
            EditorScreen.Press("wood");
            InspectorTests.Draw(surface);
            UnityEditor.IMGUI.Controls.AdvancedDropdown.Shown!.Pick("sandpaper");
            Assert.That(surface.LookUp(HapticSession.Current).Labels.Label(0), Is.Not.EqualTo(before.Label(0)));
            World.Frames(2);
            Assert.That(stylus.IsTouching, Is.True);
        }

        [Test]
        public void AStylusShowsItsRunningEffectsAndTheSceneCheckTheirCost()
        {
            HapticStylus stylus = PlayTouching(out HapticOutput output);
            string[] labels = InspectorTests.Draw(stylus).Select(item => item.Label).ToArray();
            Assert.That(labels, Has.Member("Impact").And.Member("Edge"), "the surface uses all effects");
            Assert.That(labels, Has.None.EqualTo("Delay").And.None.EqualTo("Exposure Guard"));
            output.Processing.ExposureGuard = true;
            output.ApplyProcessing();
            // The tip descends onto the table at 0.3 m/s.
            Frames(90, frame => stylus.transform.position =
                new Vector3(0f, Mathf.Max(0.001f, 0.1f - 0.3f / 90f * frame), 0f));
            Drawn[] drawn = InspectorTests.Draw(stylus).ToArray();
            Assert.That(Value(drawn, "Impact"), Does.Match("^1 impacts, [0-9]+[.][0-9] us a block$"));
            Assert.That(Value(drawn, "Exposure Guard"), Does.Match("^[0-9]+[.][0-9] us a block$"));
            CheckSceneWindow.Open();
            var window = EditorWindow.GetWindow<CheckSceneWindow>();
            string summary = EditorScreen.Draw(window.OnGUI).Select(item => item.Label)
                .Single(label => label != null && label.StartsWith("The scene uses"));
            Assert.That(summary, Does.Match("impact [(]1 surface, [0-9.]+ us a run[)]"));
            Assert.That(summary, Does.Match("exposure guard [(]1 output, [0-9.]+ us a run[)]"));
            Assert.That(summary, Does.Not.Contain("Play the scene once"));
            window.Close();
        }

        [Test]
        public void AnOutputShowsLevelUnderrunsAndMilliseconds()
        {
            PlayTouching(out HapticOutput output);
            Assert.That(output.Level, Is.GreaterThan(0f));
            Drawn[] drawn = InspectorTests.Draw(output).ToArray();
            Drawn bar = drawn.Single(item => item.Kind == DrawnKind.Bar);
            Assert.That(bar.Label, Does.StartWith("level -").And.EndsWith("dB of full scale"));
            Assert.That(Value(drawn, "Voices"), Is.EqualTo("1"));
            Assert.That(Value(drawn, "Underruns"), Does.Match("^[0-9]+$"));
            Assert.That(Value(drawn, "Rendering a block"), Does.Contain("ms, at worst"));
            Assert.That(Value(drawn, "Device"), Is.EqualTo("48000 Hz"));
            Assert.That(Value(drawn, "Quality"), Is.EqualTo("draft"));
            Assert.That(drawn.Single(item => item.Label == "Route").Enabled, Is.False);
        }

        [Test]
        public void AStylusShowsTheRuleThatAssignsTheTouchedMaterial()
        {
            HapticStylus stylus = PlayTouching(out _);
            HapticMaterialMap map = ScriptableObject.CreateInstance<HapticMaterialMap>();
            map.name = "Rooms";
            map.Add(HapticMaterialRule.ForTag("Finish", null));
            map.Add(HapticMaterialRule.ForName("Tab*", Feeling("stone")));
            HaptoFlowSettings.Active.MaterialMap = map;
            stylus.Contact.Surface!.enabled = false;
            World.Frames(2);
            Drawn[] drawn = InspectorTests.Draw(stylus).ToArray();
            Assert.That(Value(drawn, "Touches"), Is.EqualTo("Table"));
            Assert.That(Value(drawn, "Feels like"), Is.EqualTo("stone"));
            Assert.That(Value(drawn, "Because of"), Is.EqualTo("rule 2 of \"Rooms\": name \"Tab*\""));
            HaptoFlowSettings.Active.MaterialMap = null;
        }

        [Test]
        public void PanicInTheInspectorSilencesTheOutputAtOnce()
        {
            PlayTouching(out HapticOutput output);
            EditorScreen.Press("Panic");
            InspectorTests.Draw(output);
            World.Frames(20);
            Assert.That(output.Level, Is.LessThan(0.01f));
        }

        [Test]
        public void MutedInTheInspectorReachesTheVoices()
        {
            HapticStylus stylus = PlayTouching(out HapticOutput output);
            EditorScreen.Enter("Muted", true);
            InspectorTests.Draw(output);
            World.Frames(20);
            Assert.That(stylus.IsTouching, Is.True);
            Assert.That(output.Level, Is.LessThan(0.01f));
        }

        [Test]
        public void ATouchIsDrawnInTheSceneView()
        {
            HapticStylus stylus = PlayTouching(out _);
            Gizmos.Lines.Clear();
            Handles.Labels.Clear();
            StylusGizmos.Draw(stylus, GizmoType.Selected);
            Vector3 point = stylus.Contact.Point;
            Assert.That(Gizmos.Lines.Count(line => line.From == point && line.To == point + 0.02f * Vector3.up),
                Is.EqualTo(1), "the normal");
            Assert.That(Gizmos.Lines.Count(line => line.From == point && line.To == point - 0.001f * Vector3.up),
                Is.EqualTo(1), "the depth");
            Assert.That(Gizmos.Lines.Where(line => line.From == point).Select(line => (line.To - point).x).Max(),
                Is.EqualTo(0.015f).Within(0.002f), "the velocity, for a tenth of a second");
            Assert.That(Gizmos.Lines, Has.Count.EqualTo(9), "with a cross and the heads of two arrows");
            Assert.That(Handles.Labels.Single(), Does.Match("^wood: [0-9.]+ N, 1[0-9][0-9] mm/s, 1.0 mm deep$"));
            Gizmos.Lines.Clear();
            Handles.Labels.Clear();
            StylusGizmos.Draw(stylus, GizmoType.NonSelected);
            Assert.That(Gizmos.Lines, Is.Not.Empty);
            Assert.That(Handles.Labels, Is.Empty);
            Gizmos.Lines.Clear();
            StylusGizmos.Draw(Stylus(), GizmoType.Selected);
            Assert.That(Gizmos.Lines, Is.Empty, "it touches nothing");
            EditorSession.Stop();
        }

        private HapticEngine PlayWithEngine()
        {
            Settings().Quality = HapticQuality.Draft;
            Stylus();
            EditorSession.Play();
            HapticSession.Current.FinishLoading();
            return HapticSession.Current.Engine!;
        }

        /// <summary>A tip that slides, a millimetre deep, over a wooden table.</summary>
        private HapticStylus PlayTouching(out HapticOutput output)
        {
            Settings().Quality = HapticQuality.Draft;
            HapticSurface table = Tagged("Table", "wood");
            var box = table.GetComponent<BoxCollider>();
            box.size = new Vector3(1f, 0.1f, 1f);
            box.center = new Vector3(0f, -0.05f, 0f);
            Make("Listener").AddComponent<AudioListener>();
            output = Output();
            HapticStylus stylus = Stylus();
            stylus.transform.position = new Vector3(-0.2f, 0.001f, 0f);
            EditorSession.Play();
            HapticSession.Current.FinishLoading();
            Frames(45, _ => stylus.transform.position += new Vector3(0.15f / 90f, 0f, 0f));
            Assert.That(stylus.IsTouching, Is.True);
            return stylus;
        }

        private static string Value(IEnumerable<Drawn> drawn, string label) =>
            drawn.First(item => item.Label == label).Value;

        private static string[] LogLines(string part) =>
            UnityShim.Log.Lines.Select(line => line.Text).Where(text => text.Contains(part)).ToArray();
    }
}
