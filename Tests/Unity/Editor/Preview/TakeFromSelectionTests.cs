#nullable enable
using HaptoFlow.Editor;
using HaptoFlow.Model;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.PreviewTests
{
    /// <summary>The button "Take from Selection": its material and its message.</summary>
    public sealed class TakeFromSelectionTests : PreviewWindowTest
    {
        private HapticMaterialMap map = null!;

        [SetUp]
        public void AddAMapToTheScene()
        {
            map = Keep(ScriptableObject.CreateInstance<HapticMaterialMap>());
            map.name = "Rooms";
            map.Add(HapticMaterialRule.ForTag("Finish", Material("stone")));
            map.Add(HapticMaterialRule.ForName("Ghost*", null));
            Make("Scope").AddComponent<HapticMaterialMapScope>().Map = map;
            Window.Finish();
        }

        [Test]
        public void TheMaterialOfARuleIsTakenAndTheRuleIsNamed()
        {
            map.Rules[0].Material!.Description.FeatureScale = 2f;
            map.Rules[0].Material!.Description.ToneDbPerOctave = -3f;
            GameObject step = Box("Step");
            step.tag = "Finish";
            Undo.IncrementCurrentGroup();
            Assert.That(Take(step), Is.EqualTo(
                "Took stone (x2, -3 dB/oct) from Step (rule 1 of \"Rooms\": tag \"Finish\")"));
            Assert.That(Played, Is.EqualTo(("stone", 2f, -3f)));
            Undo.PerformUndo();
            Assert.That(Played, Is.EqualTo(("wood", 1f, 0f)));
        }

        [Test]
        public void AnObjectWithoutARuleHasTheDefaultOfTheMap()
        {
            map.DefaultMaterial = Material("glass");
            Assert.That(Take(Box("Lamp")), Is.EqualTo("Took glass from Lamp (default of \"Rooms\")"));
        }

        [Test]
        public void ALearntMaterialOfARuleIsTaken()
        {
            HapticMaterial learnt = Keep(HapticMaterial.Create(MaterialText.OfLabel(DefaultFile(), "glass"), "fur"));
            map.Insert(0, HapticMaterialRule.ForName("Pane", learnt));
            Assert.That(Take(Box("Pane")), Does.StartWith("Took glass from Pane (rule 1"));
            Assert.That(State.First.Learnt, Is.SameAs(learnt));
        }

        [Test]
        public void TheFirstPartWithAMaterialIsTakenAndNamed()
        {
            var mesh = Keep(new Mesh
            {
                vertices = new[]
                {
                    new Vector3(-0.1f, 0f, -0.1f), new Vector3(-0.1f, 0f, 0.1f), new Vector3(0f, 0f, -0.1f),
                    new Vector3(0f, 0f, 0.1f), new Vector3(0.1f, 0f, -0.1f), new Vector3(0.1f, 0f, 0.1f),
                },
                subMeshCount = 3,
            });
            mesh.SetTriangles(new[] { 0, 1, 3 }, 0);
            mesh.SetTriangles(new[] { 0, 3, 2 }, 1);
            mesh.SetTriangles(new[] { 2, 3, 5, 2, 5, 4 }, 2);
            map.Add(HapticMaterialRule.ForSubmesh(mesh, 1, Material("cork")));
            map.Add(HapticMaterialRule.ForSubmesh(mesh, 2, Material("glass")));
            GameObject tray = Make("Tray");
            tray.AddComponent<MeshCollider>().sharedMesh = mesh;
            Assert.That(Take(tray), Does.StartWith("Took cork from Tray (submesh 2 of 3; rule 3 of \"Rooms\""));
            map.Insert(0, HapticMaterialRule.ForName("Tray", Material("fur")));
            Assert.That(Take(tray), Does.StartWith("Took fur from Tray (rule 1"), "one rule applies to all parts");
        }

        [Test]
        public void TheMaterialOfAChildColliderIsTakenAndTheChildIsNamed()
        {
            GameObject house = Make("House");
            GameObject step = Box("Step");
            step.tag = "Finish";
            step.transform.SetParent(house.transform, false);
            Box("Attic").transform.SetParent(house.transform, false);
            Assert.That(Take(house), Is.EqualTo(
                "Took stone from House (Step; rule 1 of \"Rooms\": tag \"Finish\")"));
        }

        [Test]
        public void AnEnabledSurfaceTakesPrecedenceOverTheRules()
        {
            GameObject table = Box("Table");
            table.tag = "Finish";
            HapticSurface surface = table.AddComponent<HapticSurface>();
            surface.Material.Label = "cork";
            Assert.That(Take(table), Is.EqualTo("Took cork from Table"));
            surface.enabled = false;
            Assert.That(Take(table), Does.StartWith("Took stone from Table (rule 1"));
            table.tag = "Untagged";
            Assert.That(Take(table), Is.EqualTo("Took cork from Table (its Haptic Surface is disabled)"));
        }

        [Test]
        public void ChildrenOfASurfaceThatExcludesThemFollowTheRules()
        {
            GameObject table = Make("Table");
            HapticSurface surface = table.AddComponent<HapticSurface>();
            surface.Material.Label = "cork";
            GameObject leg = Box("Leg");
            leg.transform.SetParent(table.transform, false);
            Assert.That(Take(leg), Is.EqualTo("Took cork from Leg"));
            surface.IncludeChildren = false;
            Assert.That(Take(leg), Is.EqualTo("Leg has no haptic material (it has no Haptic Surface, and no rule matches)"));
            leg.tag = "Finish";
            Assert.That(Take(leg), Does.StartWith("Took stone from Leg (rule 1"));
        }

        [Test]
        public void ARuleWithOnlyAMaskGivesTheFirstMaterialOfTheMask()
        {
            HapticMaskMap mask = Keep(ScriptableObject.CreateInstance<HapticMaskMap>());
            mask.name = "Paint";
            mask.Green.SetMaterial(Material("cork"));
            map.Rules[0].Mask = mask;
            GameObject step = Box("Step");
            step.tag = "Finish";
            Assert.That(Take(step), Is.EqualTo(
                "Took stone from Step (rule 1 of \"Rooms\": tag \"Finish\"; without its mask Paint)"));
            map.Rules[0].Material = null;
            Assert.That(Take(step), Is.EqualTo(
                "Took cork from Step (rule 1 of \"Rooms\": tag \"Finish\"; the first material of its mask Paint)"));
        }

        [Test]
        public void AnObjectWithoutMaterialIsReported()
        {
            GameObject door = Box("Door");
            door.GetComponent<Collider>().isTrigger = true;
            int version = State.Version;
            Assert.That(Take(Box("Ghost")), Is.EqualTo("Ghost has no haptic material (rule 2 of \"Rooms\": name \"Ghost*\")"));
            Assert.That(Take(Box("Lamp")), Is.EqualTo(
                "Lamp has no haptic material (it has no Haptic Surface, and no rule matches)"));
            Assert.That(Take(Make("Light")), Is.EqualTo("Light has no haptic material (it has no collider that can be touched)"));
            Assert.That(Take(door), Is.EqualTo("Door has no haptic material (it has no collider that can be touched)"));
            Assert.That(Take(null), Is.EqualTo("Select an object of the scene or a Haptic Material first"));
            Assert.That(Take(map), Is.EqualTo("Select an object of the scene or a Haptic Material first"));
            Assert.That(State.Version, Is.EqualTo(version));
        }

        private (string, float, float) Played =>
            (State.First.Label, State.First.FeatureScale, State.First.ToneDbPerOctave);

        private string Take(Object? selected) => SceneControls.TakeFrom(selected, State, Window.Session!.Model);

        private GameObject Box(string name)
        {
            GameObject box = Make(name);
            box.AddComponent<BoxCollider>();
            return box;
        }

        private HapticMaterial Material(string label)
        {
            HapticMaterial material = Keep(ScriptableObject.CreateInstance<HapticMaterial>());
            material.name = label;
            material.Description.Label = label;
            return material;
        }
    }
}
