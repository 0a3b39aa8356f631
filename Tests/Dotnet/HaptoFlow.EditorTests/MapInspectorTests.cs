using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.EditorTests
{
    /// <summary>What the Inspectors of maps, masks and surfaces show about rules, and what entries in them change.
    /// </summary>
    public sealed class MapInspectorTests : EditorTest
    {
        [Test]
        public void ARuleShowsItsNumberAndTheFieldOfItsCondition()
        {
            HapticMaterialMap map = Map(
                HapticMaterialRule.ForTag("Finish", null), HapticMaterialRule.ForSubmesh(null, 1, null));
            string[] shown = InspectorTests.Draw(map).Select(item => item.Label).ToArray();
            Assert.That(shown, Has.Member("Rule 1").And.Member("Tag").And.Member("Rule 2").And.Member("Submesh"));
            Assert.That(shown, Has.No.Member("Terrain Layer"));
        }

        [Test]
        public void AChangedRuleAppliesAndUndoRestoresIt()
        {
            HapticMaterialMap map = Map(HapticMaterialRule.ForTag("Finish", null));
            Undo.IncrementCurrentGroup();
            int before = MaterialMaps.Version;
            EditorScreen.Enter("Tag", "Respawn");
            InspectorTests.Draw(map);
            Assert.That(MaterialMaps.Version, Is.GreaterThan(before), "at once, in play mode too");
            Assert.That(map.Rules[0].Tag, Is.EqualTo("Respawn"));
            EditorScreen.Enter("Looks At", MaterialRuleSubject.Name);
            InspectorTests.Draw(map);
            EditorScreen.Enter("Name", "Rug*");
            InspectorTests.Draw(map);
            Assert.That(map.Rules[0].Describe(), Is.EqualTo("name \"Rug*\""));
            Undo.PerformUndo();
            Assert.That(map.Rules[0].Describe(), Is.EqualTo("tag \"Finish\""));
        }

        [Test]
        public void AMaskShowsTheFieldsOfItsChannelsAndAButtonBakesIt()
        {
            HapticMaskMap mask = ScriptableObject.CreateInstance<HapticMaskMap>();
            mask.Texture = new Texture2D(2, 2, TextureFormat.RGBA32, false) { name = "Paint" };
            mask.Texture.SetPixels32(new Color32[4]);
            Assert.That(InspectorTests.Draw(mask).Select(item => item.Label), Has.No.Member("At Black"));
            EditorScreen.Enter("Red", MaskChannelUse.Strength);
            InspectorTests.Draw(mask);
            Assert.That(InspectorTests.Draw(mask).Select(item => item.Label),
                Has.Member("At Black").And.Some.Contains("is not baked"));
            EditorScreen.Press("Bake");
            InspectorTests.Draw(mask);
            Assert.That(InspectorTests.Draw(mask).Select(item => item.Label), Has.Member("Baked: 2 x 2 texels."));
        }

        [Test]
        public void AButtonMakesATextureReadable()
        {
            HapticMaskMap mask = ScriptableObject.CreateInstance<HapticMaskMap>();
            mask.name = "Ring";
            mask.Texture = new Texture2D(2, 2, TextureFormat.RGBA32, false) { name = "Paint" };
            mask.Texture.Apply(false, true);
            Assert.That(InspectorTests.Draw(mask).Where(item => item.Kind == DrawnKind.Button), Is.Empty,
                "it was not imported");
            var importer = new TextureImporter();
            AssetDatabase.AddImported(Folder + "/Paint.png", mask.Texture, importer);
            EditorScreen.Press("Enable Read/Write");
            InspectorTests.Draw(mask);
            Assert.That(importer.isReadable, Is.True);
        }

        [Test]
        public void ASurfaceShowsTheRuleThatAppliesWithoutIt()
        {
            HapticMaterialMap map = Map(HapticMaterialRule.ForTag("Finish", Feeling("stone")));
            map.name = "Rooms";
            Settings().MaterialMap = map;
            ProjectSettingsAsset.Forget();
            HapticSurface table = Tagged("Table", "wood");
            Assert.That(Extent(table), Does.Not.Contain("rule"));
            table.gameObject.tag = "Finish";
            Assert.That(Extent(table), Does.EndWith(
                "This surface takes precedence over the rules, by which the object would feel like stone (rule 1 of " +
                "\"Rooms\": tag \"Finish\")."));
            table.enabled = false;
            Assert.That(Extent(table), Does.Contain("This surface is disabled, so rules apply"));
        }

        private static string Extent(HapticSurface surface) => InspectorTests.Draw(surface)
            .Last(item => item.Kind == DrawnKind.Help).Label;

        private static HapticMaterialMap Map(params HapticMaterialRule[] rules)
        {
            HapticMaterialMap map = ScriptableObject.CreateInstance<HapticMaterialMap>();
            foreach (HapticMaterialRule rule in rules)
            {
                map.Add(rule);
            }
            return map;
        }
    }

    /// <summary>The Inspector of outputs for devices in a hand.</summary>
    public sealed class DeviceInspectorTests : EditorTest
    {
        [TearDown]
        public void ForgetDevices() => HeldDevices.Reset();

        [TestCase(typeof(AutoOutput))]
        [TestCase(typeof(MotorOutput))]
        [TestCase(typeof(ControllerWaveformOutput))]
        [TestCase(typeof(ControllerParametricOutput))]
        public void EveryDeviceOutputShowsItsOwnFieldsWithTheirTooltips(Type kind)
        {
            var output = (DeviceOutput)World.AddComponent(Make("Pen"), kind);
            IReadOnlyList<Drawn> drawn = InspectorTests.Draw(output);
            Assert.That(drawn.Select(item => item.Label), Is.SupersetOf(new[] { "Stylus", "Hand", "Strength", "Muted" }));
            Assert.That(drawn.Single(item => item.Label == "Hand").Tooltip, Does.Contain("whose device plays"));
            Assert.That(drawn.Select(item => item.Label), Has.None.EqualTo("Now"), "nothing plays in edit mode");
        }

        [Test]
        public void WhilePlayingItNamesDeviceFormLatencyAndGaps()
        {
            XrHand.Right.Take("Some controller", true);
            MotorOutput output = Playing();
            Assert.That(Value(output, "Device"), Is.EqualTo("Some controller, right hand"));
            Assert.That(Value(output, "Form"), Is.EqualTo("one amplitude at a time"));
            Assert.That(Value(output, "Latency"), Is.EqualTo("nothing plays"));
            Assert.That(Value(output, "Gaps"), Is.EqualTo("0"));
            Assert.That(Value(output, "Device changed"), Is.EqualTo("0 times"));
        }

        [Test]
        public void WithoutADeviceItSaysWhereItLooks()
        {
            MotorOutput output = Playing();
            Assert.That(Value(output, "Device"), Is.EqualTo("none in the right hand that takes this output"));
            output.Hand = HapticHand.None;
            Assert.That(Value(output, "Device"), Does.Contain("no hand").And.Contain("Hand"));
        }

        [Test]
        public void MutedAndPanicActWhilePlaying()
        {
            XrHand.Right.Take("Some controller", true);
            MotorOutput output = Playing();
            EditorScreen.Enter("Muted", true);
            InspectorTests.Draw(output);
            Assert.That(output.Muted, Is.True);
            EditorScreen.Press("Panic");
            Assert.DoesNotThrow(() => InspectorTests.Draw(output));
        }

        private MotorOutput Playing()
        {
            Settings();
            HapticStylus stylus = Stylus();
            MotorOutput output = stylus.gameObject.AddComponent<MotorOutput>();
            output.Hand = HapticHand.Right;
            EditorSession.Play();
            World.Frames(3);
            return output;
        }

        private static string Value(UnityEngine.Object target, string label) =>
            InspectorTests.Draw(target).Single(item => item.Label == label).Value;
    }
}
