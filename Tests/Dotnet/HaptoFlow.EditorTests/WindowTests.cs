using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.EditorTests
{
    /// <summary>Settings pages, windows, the overlay and menus, with simulated button presses.</summary>
    public sealed class WindowTests : EditorTest
    {
        [Test]
        public void TheSettingsPageCreatesOneAssetOnRequest()
        {
            SettingsProvider page = HaptoFlowSettingsPage.Create();
            Assert.That(page.settingsPath, Is.EqualTo("Project/HaptoFlow"));
            Assert.That(page.scope, Is.EqualTo(SettingsScope.Project));
            EditorScreen.Draw(() => page.OnGUI(""));
            Assert.That(AssetDatabase.FindAssets("t:HaptoFlowSettings"), Is.Empty, "drawing the page creates no settings");
            EditorScreen.Press("Create Settings");
            EditorScreen.Draw(() => page.OnGUI(""));
            IReadOnlyList<Drawn> drawn = EditorScreen.Draw(() => page.OnGUI(""));
            Assert.That(drawn.Select(item => item.Label), Has.None.EqualTo("Create Settings"));
            Assert.That(AssetDatabase.FindAssets("t:HaptoFlowSettings"), Has.Length.EqualTo(1));
            Assert.That(drawn.Single(item => item.Label == "Model").Value, Is.EqualTo("default"));
        }

        [Test]
        public void AnEnteredSettingIsSavedAndUndone()
        {
            HaptoFlowSettings settings = Settings();
            Undo.IncrementCurrentGroup();
            EditorScreen.Enter("Update Rate (Hz)", 120f);
            EditorScreen.Draw(HaptoFlowSettingsPage.Draw);
            Assert.That(settings.UpdateRateHz, Is.EqualTo(120f));
            Undo.PerformUndo();
            Assert.That(settings.UpdateRateHz, Is.EqualTo(72f));
        }

        [Test]
        public void TheBudgetIsEnabledOnlyForAutoQuality()
        {
            HaptoFlowSettings settings = Settings();
            Assert.That(Page().Single(item => item.Label == "Budget Share").Enabled, Is.True);
            settings.Quality = HapticQuality.Standard;
            Assert.That(Page().Single(item => item.Label == "Budget Share").Enabled, Is.False);
            settings.Model = null;
            Assert.That(Page().Select(item => item.Label), Has.Member("The field Model is empty: nothing is felt."));
        }

        [Test]
        public void AQualityThatTheSettingsHoldFromAnEarlierVersionIsStandardAndIsRepaired()
        {
            HaptoFlowSettings settings = Settings();
            settings.Quality = (HapticQuality)3;
            Assert.That(settings.Quality, Is.EqualTo(HapticQuality.Standard), "in a player, where nothing validates");
            Assert.That(new SerializedObject(settings).FindProperty("quality").intValue, Is.EqualTo(3));
            EditorScreen.Enter("Update Rate (Hz)", 90f);
            EditorScreen.Draw(HaptoFlowSettingsPage.Draw);
            Assert.That(new SerializedObject(settings).FindProperty("quality").intValue, Is.EqualTo(2));
            Assert.That(settings.UpdateRateHz, Is.EqualTo(90f));
        }

        [Test]
        public void SettingsThatPlayersWouldLackCanBePreloaded()
        {
            HaptoFlowSettings settings = Settings();
            PlayerSettings.SetPreloadedAssets(new Object[0]);
            EditorScreen.Press("Add to Preloaded Assets");
            Page();
            Assert.That(ProjectSettingsAsset.IsPreloaded(settings), Is.True);
        }

        [Test]
        public void SettingsThatAreNotTheProjectsSaySo()
        {
            HaptoFlowSettings settings = Settings();
            Assert.That(Helps(InspectorTests.Draw(settings)), Is.Empty);
            HaptoFlowSettings other = ScriptableObject.CreateInstance<HaptoFlowSettings>();
            other.Model = Model();
            Assert.That(Helps(InspectorTests.Draw(other)).Single(), Does.Contain("Project Settings > HaptoFlow"));
        }

        [Test]
        public void TheSceneCheckListsFindingsAndAButtonRepairsOne()
        {
            Settings();
            Stylus();
            Output();
            HapticSurface shelf = Tagged("Shelf", "plywod");
            CheckSceneWindow.Open();
            var window = EditorWindow.GetWindow<CheckSceneWindow>();
            Assert.That(Helps(EditorScreen.Draw(window.OnGUI)), Has.Length.EqualTo(1));
            EditorScreen.Press("Use \"plywood\"");
            EditorScreen.Draw(window.OnGUI);
            Assert.That(shelf.Material.Label, Is.EqualTo("plywood"));
            IReadOnlyList<Drawn> drawn = EditorScreen.Draw(window.OnGUI);
            Assert.That(Helps(drawn), Is.Empty);
            Assert.That(drawn.Select(item => item.Label), Has.Member("No findings"));
            window.Close();
        }

        [Test]
        public void TheSceneCheckShowsTheEffectsInUseAndTheirCostAfterPlaying()
        {
            Settings();
            HapticStylus stylus = Stylus();
            HapticOutput output = Output();
            output.Processing.ExposureGuard = true;
            HapticSurface table = Tagged("Table", "wood");
            table.Material.Effects = HapticEffects.Texture;
            HapticSurface shelf = Tagged("Shelf", "wood");
            shelf.Material.Effects = HapticEffects.Texture | HapticEffects.Impact;
            CheckSceneWindow.Open();
            var window = EditorWindow.GetWindow<CheckSceneWindow>();
            Assert.That(EditorScreen.Draw(window.OnGUI).Select(item => item.Label), Has.Member(
                "The scene uses texture (2 surfaces), impact (1 surface), exposure guard (1 output). No other effect " +
                "runs. Play the scene once to see what each costs on this machine."));
            table.Material.Effects = HapticEffects.Nothing;
            Object.DestroyImmediate(shelf.gameObject);
            output.Processing.ExposureGuard = false;
            EditorSession.ChangeHierarchy();
            IReadOnlyList<Drawn> drawn = EditorScreen.Draw(window.OnGUI);
            Assert.That(Helps(drawn).Single(), Does.Contain("No surface has an effect"));
            Assert.That(drawn.Select(item => item.Label), Has.None.Contain("uses texture"));
            window.Close();
        }

        [Test]
        public void TheSceneCheckSelectsTheObjectsOfAFinding()
        {
            Settings();
            Stylus();
            Output();
            GameObject thing = Box("Thing");
            CheckSceneWindow.Open();
            var window = EditorWindow.GetWindow<CheckSceneWindow>();
            EditorScreen.Press("Select");
            EditorScreen.Draw(window.OnGUI);
            Assert.That(Selection.objects, Is.EqualTo(new Object[] { thing }));
            Assert.That(EditorSession.Pinged, Is.EqualTo(thing));
            window.Close();
        }

        [Test]
        public void LongAudioBlocksAreAFindingThatOpensTheAudioSettings()
        {
            Settings();
            AudioDevice.ChangeDevice(48000, 1024, AudioSpeakerMode.Stereo);
            Finding finding = SceneCheck.Run().Single();
            Assert.That(finding.Text, Does.Contain("1024 frames, 21 ms at 48000 Hz"));
            finding.Repairs.Single().Act();
            Assert.That(EditorSession.OpenedSettings, Is.EqualTo("Project/Audio"));
        }

        [Test]
        public void ADeviceTooSlowForHapticsIsAnError()
        {
            Settings();
            AudioDevice.ChangeDevice(4000, 64, AudioSpeakerMode.Stereo);
            Assert.That(SceneCheck.Run().Single().Severity, Is.EqualTo(MessageType.Error));
        }

        [Test]
        public void TheOverlayListsCollidersAndAClickShowsOne()
        {
            Tagged("Table", "wood");
            GameObject lamp = Box("Lamp");
            var overlay = new SurfaceOverlay();
            overlay.OnCreated();
            string[] drawn = EditorScreen.Draw(overlay.OnGUI).Select(item => item.Label).ToArray();
            Assert.That(drawn, Is.EqualTo(
                new[] { "In the scene", "Not felt (1)", "Lamp", "Felt (1)", "Table: wood" }));
            EditorScreen.Press("Lamp");
            EditorScreen.Draw(overlay.OnGUI);
            Assert.That(EditorSession.Pinged, Is.EqualTo(lamp));
            overlay.OnWillBeDestroyed();
        }

        [Test]
        public void TheOverlayFollowsTheSelectionAndChanges()
        {
            HapticSurface table = Tagged("Table", "wood");
            Box("Lamp");
            var overlay = new SurfaceOverlay();
            overlay.OnCreated();
            EditorScreen.Draw(overlay.OnGUI);
            Selection.activeObject = table.gameObject;
            Assert.That(EditorScreen.Draw(overlay.OnGUI)[0].Label, Is.EqualTo("In the selection"));
            EditorScreen.Enter("Strength", 0.5f);
            EditorScreen.Press("wood");
            InspectorTests.Draw(table);
            UnityEditor.IMGUI.Controls.AdvancedDropdown.Shown!.Pick("glass");
            Assert.That(EditorScreen.Draw(overlay.OnGUI).Last().Label, Is.EqualTo("Table: glass"));
            overlay.OnWillBeDestroyed();
        }

        [Test]
        public void TheOverlayOfALargeSceneShowsALimitedNumberOfLines()
        {
            for (int index = 0; index < 40; ++index)
            {
                Box("Thing " + index);
            }
            IReadOnlyList<Drawn> drawn = EditorScreen.Draw(new SurfaceOverlay().OnGUI);
            Assert.That(drawn.Count, Is.LessThan(20));
            Assert.That(drawn.Select(item => item.Label), Has.Member("Not felt (40)"));
        }

        [Test]
        public void TheMenuTagsAllSelectedObjectsOnceAndLogsTheResult()
        {
            GameObject[] selected = { Box("Oak_Table"), Box("Steel Door"), Box("Thing") };
            Selection.objects = selected;
            Assert.That(GameObjectMenu.CanTag(), Is.True);
            foreach (GameObject each in selected)
            {
                GameObjectMenu.TagSelected(new MenuCommand(each));
            }
            string line = UnityShim.Log.Lines.Single().Text;
            Assert.That(line, Does.Contain("Oak_Table as wood (name), Steel Door as metal (name)"));
            Assert.That(line, Does.Contain("left untagged").And.EndsWith(": Thing."));
            Selection.objects = new Object[0];
            Assert.That(GameObjectMenu.CanTag(), Is.False);
        }

        private static IReadOnlyList<Drawn> Page() => EditorScreen.Draw(HaptoFlowSettingsPage.Draw);

        private static string[] Helps(IEnumerable<Drawn> drawn) =>
            drawn.Where(item => item.Kind == DrawnKind.Help).Select(item => item.Label).ToArray();
    }
}
