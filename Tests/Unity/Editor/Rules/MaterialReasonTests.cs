#nullable enable
using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.EditorTests
{
    /// <summary>The reasons for a collider's material in edit mode, in the overlay and in the Inspector of a map.
    /// </summary>
    public sealed class MaterialReasonTests : EditorTest
    {
        private HapticMaterialMap map = null!;

        [SetUp]
        public void AddAMapToTheProject()
        {
            map = CreateMap();
            Settings().MaterialMap = map;
            ProjectSettingsAsset.Forget();
            map.Add(HapticMaterialRule.ForTag("Finish", Material("stone")));
            map.Add(HapticMaterialRule.ForName("Ghost*", null));
        }

        [Test]
        public void TheOverlayListsMaterialsAndRules()
        {
            Tagged("Table", "wood");
            Box("Step").tag = "Finish";
            Box("Ghost");
            Box("Lamp");
            SurfaceList list = SurfaceList.Of(new GameObject[0]);
            Assert.That(list.Felt.Select(line => line.Text), Is.EqualTo(new[]
            {
                "Step: stone (rule 1 of \"Rooms\": tag \"Finish\")", "Table: wood",
            }));
            Assert.That(list.NotFelt.Select(line => line.Text), Is.EqualTo(new[]
            {
                "Ghost (rule 2 of \"Rooms\": name \"Ghost*\")", "Lamp",
            }));
        }

        [Test]
        public void AScopeOfTheSceneTakesPrecedenceOverTheProjectsMap()
        {
            HapticMaterialMap ofScene = ScriptableObject.CreateInstance<HapticMaterialMap>();
            ofScene.name = "Cellar";
            ofScene.DefaultMaterial = Material("glass");
            HapticMaterialMapScope scope = Make("Scope").AddComponent<HapticMaterialMapScope>();
            scope.Map = ofScene;
            GameObject step = Box("Step");
            step.tag = "Finish";
            Assert.That(Line(step), Is.EqualTo("Step: glass (default of \"Cellar\")"));
            scope.enabled = false;
            Assert.That(Line(step), Is.EqualTo("Step: stone (rule 1 of \"Rooms\": tag \"Finish\")"));
        }

        [Test]
        public void RulesApplyToTheColliderOfADisabledSurface()
        {
            HapticSurface table = Tagged("Table", "wood");
            table.gameObject.tag = "Finish";
            Assert.That(Line(table.gameObject), Is.EqualTo("Table: wood"));
            table.enabled = false;
            Assert.That(Line(table.gameObject), Does.StartWith("Table: stone (rule 1"));
        }

        [Test]
        public void AMapShowsWhatEachOfItsRulesMatches()
        {
            Box("Step").tag = "Finish";
            Assert.That(HapticMaterialMapEditor.LinesOf(map).Select(line => line.Text), Is.EqualTo(new[]
            {
                "Rule 1: tag \"Finish\" \u2192 stone: Step", "Rule 2: name \"Ghost*\" \u2192 nothing: no collider",
            }));
            HapticMaterialMap idle = ScriptableObject.CreateInstance<HapticMaterialMap>();
            Assert.That(HapticMaterialMapEditor.LinesOf(idle).Single().Text, Does.StartWith("This map is not in use"));
        }

        private static string Line(GameObject owner)
        {
            SurfaceList list = SurfaceList.Of(new[] { owner });
            return list.Felt.Concat(list.NotFelt).Single().Text;
        }

        private static HapticMaterial Material(string label)
        {
            HapticMaterial material = ScriptableObject.CreateInstance<HapticMaterial>();
            material.name = label;
            material.Description.Label = label;
            return material;
        }
    }
}
