using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using HaptoFlow.Editor;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEditor;
using UnityEditor.IMGUI.Controls;
using UnityEngine;
using UnityEngine.TestTools;
using UnityShim;
using Object = UnityEngine.Object;
using SerializedFields = UnityShim.SerializedFields;

namespace HaptoFlow.EditorTests
{
    /// <summary>What the Inspectors show, and what the user's entries in them change.</summary>
    public sealed class InspectorTests : EditorTest
    {
        [Test]
        public void AModelFileShowsItsLabelsTiersProvenanceAndLicence()
        {
            _ = Model();
            IReadOnlyList<Drawn> drawn = Draw(AssetImporter.GetAtPath(ProjectSettingsAsset.DefaultModelPath)!);
            string[] labels = Model().Header.Labels.Select(label => label.Name).ToArray();
            Assert.That(labels, Has.Length.EqualTo(20).And.SubsetOf(drawn.Select(item => item.Label)));
            int tiers = Model().Header.Tiers.Count;
            Assert.That(drawn.Count(item => item.Label == "Accuracy"), Is.EqualTo(tiers));
            Assert.That(drawn.Count(item => item.Label == "Time"), Is.EqualTo(tiers));
            Assert.That(Value(drawn, "Licence"), Is.EqualTo("MIT"));
            Assert.That(drawn.Select(item => item.Kind), Has.None.EqualTo(DrawnKind.Button), "nothing to apply");
        }

        [Test]
        public void ADamagedModelFileShowsItsErrorOnly()
        {
            LogAssert.ignoreFailingMessages = true;
            string path = Import("cut.haptoflow", ModelBytes.Truncated(Model().File, 70000));
            IReadOnlyList<Drawn> drawn = Draw(AssetImporter.GetAtPath(path)!);
            Assert.That(drawn, Has.Count.EqualTo(1));
            Assert.That(drawn[0].Kind, Is.EqualTo(DrawnKind.Help));
            Assert.That(drawn[0].Label, Does.Contain("has 70000: get it again"));
        }

        [Test]
        public void AModelAssetWithoutAFileShowsTheSameSummary() =>
            Assert.That(Value(Draw(HapticModelAsset.Create(Model().File)), "Licence"), Is.EqualTo("MIT"));

        [Test]
        public void ALabelIsChosenFromTheList()
        {
            HapticSurface surface = Tagged("Table", "wood");
            Undo.IncrementCurrentGroup();
            Pick(surface, "wood", "glass");
            Assert.That(surface.Material.Label, Is.EqualTo("glass"));
            Undo.PerformUndo();
            Assert.That(surface.Material.Label, Is.EqualTo("wood"));
        }

        [Test]
        public void AnUnknownLabelStaysVisibleUntilAnotherIsChosen()
        {
            HapticSurface surface = Tagged("Table", "plywod");
            Drawn shown = Draw(surface).Single(item => item.Label == "plywod (not in model)");
            Assert.That(shown.Tooltip, Does.Contain("similar ones"));
            Assert.That(surface.Material.Label, Is.EqualTo("plywod"), "drawing changes nothing");
            Pick(surface, "plywod (not in model)", "plywod (not in model)");
            Assert.That(surface.Material.Label, Is.EqualTo("plywod"));
            Pick(surface, "plywod (not in model)", "plywood (near \"plywod\")");
            Assert.That(surface.Material.Label, Is.EqualTo("plywood"));
        }

        [Test]
        public void OneUndoRestoresTheLabelsOfSeveralSurfaces()
        {
            HapticSurface table = Tagged("Table", "wood");
            HapticSurface door = Tagged("Door", "metal");
            EditorScreen.Press("\u2014");
            Draw(table, door);
            Undo.IncrementCurrentGroup();
            AdvancedDropdown.Shown!.Pick("stone");
            Assert.That(new[] { table, door }.Select(each => each.Material.Label), Is.All.EqualTo("stone"));
            Undo.PerformUndo();
            Assert.That(table.Material.Label, Is.EqualTo("wood"));
            Assert.That(door.Material.Label, Is.EqualTo("metal"));
        }

        [Test]
        public void AnEnteredValueAppliesToAllSelectedSurfaces()
        {
            HapticSurface table = Tagged("Table", "wood");
            HapticSurface door = Tagged("Door", "metal");
            door.Material.Strength = 0.25f;
            Assert.That(Value(Draw(table, door), "Strength"), Is.EqualTo("—"));
            EditorScreen.Enter("Strength", 0.5f);
            Draw(table, door);
            Assert.That(table.Material.Strength, Is.EqualTo(0.5f));
            Assert.That(door.Material.Strength, Is.EqualTo(0.5f));
            Assert.That(door.Material.Label, Is.EqualTo("metal"), "fields without an entry keep their values");
        }

        [Test]
        public void AMaterialFileShowsItsRecordingAndADamagedOneItsKey()
        {
            LogAssert.ignoreFailingMessages = true;
            string text = HaptoFlow.Model.MaterialText.OfLabel(Model().File, "glass");
            string path = Import("glass.haptomaterial", System.Text.Encoding.UTF8.GetBytes(text));
            IReadOnlyList<Drawn> drawn = Draw(AssetImporter.GetAtPath(path)!);
            Assert.That(Value(drawn, "Nearest Label"), Is.EqualTo("glass"));
            Assert.That(Value(drawn, "Licence"), Is.EqualTo("MIT"));
            Assert.That(drawn.Single(item => item.Kind == DrawnKind.Button).Enabled, Is.True);
            path = Import("cut.haptomaterial", System.Text.Encoding.UTF8.GetBytes(text.Substring(0, 300)));
            drawn = Draw(AssetImporter.GetAtPath(path)!);
            Assert.That(drawn.Single(item => item.Kind == DrawnKind.Help).Label, Does.Contain("cannot be used"));
            Assert.That(drawn.Single(item => item.Kind == DrawnKind.Button).Enabled, Is.False);
        }

        [Test]
        public void AClipFileShowsItsPictureItsDurationAndWhatIsNotPlayedAndADamagedOneItsKey()
        {
            LogAssert.ignoreFailingMessages = true;
            const string Tap = "{\"Version\":1.0,\"Pattern\":[{\"Event\":{\"EventType\":\"HapticTransient\",\"Time\":0.1," +
                "\"EventParameters\":[]}},{\"Event\":{\"EventType\":\"AudioCustom\",\"Time\":0.0," +
                "\"EventWaveformPath\":\"a.wav\",\"EventParameters\":[]}}]}";
            string path = Import("tap.ahap", System.Text.Encoding.UTF8.GetBytes(Tap));
            AssetDatabase.SetImporterOverride<HapticClipImporter>(path);
            IReadOnlyList<Drawn> drawn = Draw(AssetImporter.GetAtPath(path)!);
            Assert.That(Value(drawn, "Transients"), Is.EqualTo("1"));
            Assert.That(drawn.Single(item => item.Kind == DrawnKind.Help).Label, Does.StartWith("Not played: "));
            HapticClip clip = AssetDatabase.LoadAssetAtPath<HapticClip>(path);
            Assert.That(Value(Draw(clip), "Transients"), Is.EqualTo("1"));
            EditorScreen.Press("Play");
            Draw(clip);
            var played = new float[ClipPreview.Playing!.samples];
            ClipPreview.Playing.GetData(played, 0);
            Assert.That(played.Max(sample => Math.Abs(sample)), Is.EqualTo(0.9f).Within(1e-4f));
            path = Import("cut.hjif", System.Text.Encoding.UTF8.GetBytes("{\"MPEG_haptics\":{"));
            drawn = Draw(AssetImporter.GetAtPath(path)!);
            Assert.That(drawn.Single().Label, Does.StartWith("This clip cannot be used: "));
        }

        [Test]
        public void ALearntMaterialShowsItsOriginAndItsReplacementLabel()
        {
            var material = HapticMaterial.Create(HaptoFlow.Model.MaterialText.OfLabel(Model().File, "glass"), "fur");
            IReadOnlyList<Drawn> drawn = Draw(material);
            Assert.That(Value(drawn, "Nearest Label"), Is.EqualTo("glass"));
            Assert.That(Value(drawn, "Learnt Material"), Is.EqualTo("this asset"));
            Assert.That(drawn.Select(item => item.Label), Does.Contain("fur"));
        }

        [Test]
        public void TheInspectorsOfSurfacesAndMaterialsOpenThePreview()
        {
            HapticSurface surface = Tagged("Table", "glass");
            EditorScreen.Press("Preview");
            Draw(surface);
            var window = EditorWindow.GetWindow<TexturePreviewWindow>();
            Assert.That(window.State.First.Label, Is.EqualTo("glass"));
            EditorScreen.Press("Preview");
            Draw(Feeling("cork"));
            Assert.That(window.State.First.Label, Is.EqualTo("cork"));
            WindowHost.Close(window);
        }

        [Test]
        public void BlendIsEnabledOnlyWithASecondLabel()
        {
            HapticSurface surface = Tagged("Table", "wood");
            Assert.That(Draw(surface).Single(item => item.Label == "Blend").Enabled, Is.False);
            surface.Material.SecondLabel = "glass";
            Assert.That(Draw(surface).Single(item => item.Label == "Blend").Enabled, Is.True);
        }

        [Test]
        public void AStiffnessOfZeroShowsTheModelsValue()
        {
            HapticSurface surface = Tagged("Table", "wood");
            Assert.That(Draw(surface).Select(item => item.Label), Has.Member("0: the model's 1200"));
            surface.Material.StiffnessNewtonsPerMetre = 500f;
            Assert.That(Draw(surface).Select(item => item.Label), Has.None.EqualTo("0: the model's 1200"));
        }

        [Test]
        public void ASharedMaterialIsEditedInTheInspectorOfTheSurface()
        {
            HapticSurface surface = Tagged("Table", "wood");
            HapticMaterial shared = ScriptableObject.CreateInstance<HapticMaterial>();
            surface.SharedMaterial = shared;
            EditorScreen.Enter("Strength", 0.25f);
            Assert.That(Draw(surface).Select(item => item.Label), Has.Some.Contains("every surface that shares"));
            Assert.That(shared.Description.Strength, Is.EqualTo(0.25f));
            EditorScreen.Enter("Strength", 0.75f);
            Draw(shared);
            Assert.That(shared.Description.Strength, Is.EqualTo(0.75f));
        }

        [Test]
        public void ANewSharedMaterialIsDrawnFromTheNextEventOn()
        {
            HapticSurface surface = Tagged("Table", "wood");
            HapticMaterial shared = ScriptableObject.CreateInstance<HapticMaterial>();
            EditorScreen.Enter("Shared Material", shared);
            int before = Draw(surface).Count;
            Assert.That(surface.SharedMaterial, Is.EqualTo(shared));
            Assert.That(Draw(surface), Has.Count.GreaterThan(before));
        }

        [Test]
        public void ASurfaceShowsHowManyOfItsCollidersCanBeFelt()
        {
            HapticSurface surface = Tagged("Table", "wood");
            Assert.That(Draw(surface).Last().Label, Is.EqualTo("One collider can be felt."));
            Make("Vase", surface.gameObject).AddComponent<MeshCollider>();
            Assert.That(Draw(surface).Last().Label, Does.StartWith("2 colliders can be felt.").And.Contain("20 mm"));
            surface.IncludeChildren = false;
            surface.GetComponent<BoxCollider>().isTrigger = true;
            Assert.That(Draw(surface).Last().Label, Does.StartWith("No collider here can be felt"));
        }

        [Test]
        public void AnOutputShowsTheFieldsOfItsRoute()
        {
            HapticOutput output = Output();
            Assert.That(Fields(output), Is.EqualTo(new[]
            {
                "Route", "Channel", "Play While Paused", "Obey Listener", "Strength", "Muted", "Listen", "Actuator", "Exposure Guard",
                "Delay (ms)",
            }));
            EditorScreen.Enter("Route", OutputRoute.MixerEffect);
            Draw(output);
            Assert.That(output.Route, Is.EqualTo(OutputRoute.MixerEffect));
            Assert.That(Fields(output),
                Is.EqualTo(new[]
                {
                    "Route", "Audio Mixer", "Voice Parameter", "Play While Paused", "Strength", "Muted", "Listen",
                    "Actuator", "Exposure Guard",
                    "Delay (ms)",
                }));
        }

        [Test]
        public void ForceThresholdsAreShownOnlyForMeasuredForce()
        {
            HapticStylus stylus = Stylus();
            Assert.That(Fields(stylus), Has.No.Member("Press Force (N)"));
            EditorScreen.Enter("Touch By", TouchDecision.MeasuredForce);
            Draw(stylus);
            Assert.That(stylus.TouchBy, Is.EqualTo(TouchDecision.MeasuredForce));
            Assert.That(Fields(stylus), Has.Member("Press Force (N)"));
            EditorScreen.Enter("Press Force (N)", 0.25f);
            Draw(stylus);
            Assert.That(stylus.ForceDecision.PressNewtons, Is.EqualTo(0.25f));
            Assert.That(Draw(stylus).Select(item => item.Label), Has.Some.Contains("geometry decides"));
        }

        internal static IReadOnlyList<Drawn> Draw(params Object[] targets)
        {
            UnityEditor.Editor editor = UnityEditor.Editor.CreateEditor(targets);
            return EditorScreen.Draw(editor.OnInspectorGUI);
        }

        private static string[] Fields(Object target) =>
            Draw(target).Where(item => item.Kind == DrawnKind.Field).Select(item => item.Label).ToArray();

        private static string Value(IEnumerable<Drawn> drawn, string label) =>
            drawn.Single(item => item.Label == label).Value;

        private static void Pick(HapticSurface surface, string shown, string chosen)
        {
            EditorScreen.Press(shown);
            Draw(surface);
            AdvancedDropdown.Shown!.Pick(chosen);
        }
    }

    public sealed class FieldTooltipTests : EditorTest
    {
        /// <summary>For every value of every choice, because choices show and hide fields. Lists have an element. A
        /// tooltip that an Inspector wrote itself would stand twice, and soon in other words.</summary>
        [TestCase(typeof(HapticStylus))]
        [TestCase(typeof(HapticSurface))]
        [TestCase(typeof(HapticMaterial))]
        [TestCase(typeof(HapticOutput))]
        [TestCase(typeof(AutoOutput))]
        [TestCase(typeof(HapticMaterialMap))]
        [TestCase(typeof(HapticMaskMap))]
        [TestCase(typeof(HaptoFlowSettings))]
        public void EveryFieldIsShownWithTheTooltipThatIsWrittenOnIt(Type type)
        {
            Object target = typeof(Component).IsAssignableFrom(type)
                ? World.AddComponent(Make("Owner"), type)
                : ScriptableObject.CreateInstance(type);
            foreach (string size in SerializedFields.Leaves(target).Where(path => path.EndsWith(".Array.size")).ToArray())
            {
                SerializedFields.Set(target, size, 1);
            }
            var editor = UnityEditor.Editor.CreateEditor(new[] { target });
            var drawn = new List<Drawn>(EditorScreen.Draw(editor.OnInspectorGUI));
            foreach (string path in SerializedFields.Leaves(target).ToArray())
            {
                object? before = SerializedFields.Get(target, path);
                foreach (object value in before is Enum ? Enum.GetValues(before.GetType()) : Array.Empty<object>())
                {
                    SerializedFields.Set(target, path, value);
                    drawn.AddRange(EditorScreen.Draw(editor.OnInspectorGUI));
                }
                SerializedFields.Set(target, path, before);
            }
            Drawn[] fields = drawn.Where(item => item.Kind == DrawnKind.Field).ToArray();
            Assert.That(fields, Is.Not.Empty);
            const BindingFlags fieldsOfAType = BindingFlags.Instance | BindingFlags.NonPublic | BindingFlags.DeclaredOnly;
            HashSet<string> written = HelpTests.Assemblies.SelectMany(assembly => assembly.GetTypes())
                .SelectMany(each => each.GetFields(fieldsOfAType)).Select(field => field.GetCustomAttribute<TooltipAttribute>()?.tooltip).OfType<string>().ToHashSet();
            Assert.That(fields.Where(item => !written.Contains(item.Tooltip)).Select(item => (item.Label, item.Tooltip)),
                Is.Empty);
        }
    }

    public sealed class LevelMeterTests
    {
        [TestCase(2f, 1f, "level 6 dB of full scale")]
        [TestCase(1f, 1f, "level 0 dB of full scale")]
        [TestCase(0.98f, 0.997f, "level 0 dB of full scale")]
        [TestCase(0.0316f, 0.5f, "level -30 dB of full scale")]
        [TestCase(0.001f, 0f, "silent")]
        [TestCase(0f, 0f, "silent")]
        public void ALevelIsABarFromMinusSixtyDecibelsToFullScale(float level, float share, string caption)
        {
            Assert.That(LevelMeter.Of(level).Share, Is.EqualTo(share).Within(1e-3f));
            Assert.That(LevelMeter.Of(level).Caption, Is.EqualTo(caption));
        }
    }
}
