#nullable enable
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.EditorTests
{
    /// <summary>What Check Scene reports about maps: the material of each collider with its reason, and rules without
    /// effect.</summary>
    public sealed class MapCheckTests : SceneCheckTest
    {
        private HapticMaterialMap map = null!;

        [SetUp]
        public void AddAMapToTheProject()
        {
            map = CreateMap();
            ProjectSettings.MaterialMap = map;
        }

        [Test]
        public void EveryColliderIsListedWithItsMaterialAndRule()
        {
            map.Add(HapticMaterialRule.ForTag("Finish", Feeling("stone")));
            map.Add(HapticMaterialRule.ForName("Cloud*", null));
            Box("Step 1").tag = "Finish";
            Box("Step 2").tag = "Finish";
            Box("Cloud");
            Box("Mist");
            Assert.That(Texts(), Is.SupersetOf(new[]
            {
                "Table: felt as wood (Haptic Surface on \"Table\").",
                "Step 1, Step 2: felt as stone (rule 1 of \"Rooms\": tag \"Finish\").",
                "Cloud: not felt (rule 2 of \"Rooms\": name \"Cloud*\").",
                "Mist: not felt (no rule matches).",
            }));
            Assert.That(Findings().Single(finding => finding.Text.StartsWith("Step")).Objects, Has.Count.EqualTo(2));
        }

        [Test]
        public void OnlyCollidersThatNoRuleMatchesAreProposedForTagging()
        {
            map.Add(HapticMaterialRule.ForName("*Door", Feeling("wood")));
            Box("Steel Door");
            Assert.That(Texts(), Has.None.Contains("is not tagged"));
            Box("Steel Shelf");
            Assert.That(Texts(), Has.Exactly(1).Contains("Steel Shelf is not tagged; its name suggests metal"));
        }

        [Test]
        public void ARuleThatAnEarlierOneCoversIsFoundAndRemovedWithOneUndo()
        {
            map.Add(HapticMaterialRule.ForName("Rug*", Feeling("fur")));
            map.Add(HapticMaterialRule.ForName("rug (*)", Feeling("wood")));
            Finding finding = With("Rule 2 of Rooms never matches: rule 1 (name \"Rug*\")");
            Undo.IncrementCurrentGroup();
            finding.Repairs.Single().Act();
            Assert.That(map.Rules, Has.Count.EqualTo(1));
            Assert.That(Texts(), Has.None.Contains("never matches"));
            Undo.PerformUndo();
            Assert.That(map.Rules.Select(rule => rule.NamePattern), Is.EqualTo(new[] { "Rug*", "rug (*)" }));
        }

        [Test]
        public void RulesThatOnlyOverlapAreNoFinding()
        {
            map.Add(HapticMaterialRule.ForName("*Rug", Feeling("fur")));
            map.Add(HapticMaterialRule.ForName("Rug*", Feeling("wood")));
            map.Add(HapticMaterialRule.ForTag("Finish", Feeling("stone")));
            map.Add(HapticMaterialRule.ForLayer(4, Feeling("glass")));
            map.Add(HapticMaterialRule.ForSubmesh(null, 1, Feeling("glass")));
            map.Add(HapticMaterialRule.ForSubmesh(null, 0, Feeling("glass")));
            Assert.That(Texts(), Has.None.Contains("never matches"));
            map.Insert(0, HapticMaterialRule.ForName("*", null));
            Assert.That(Texts(), Has.Exactly(6).Contains("never matches"));
        }

        [Test]
        public void TagsAndLayersThatTheProjectDoesNotHaveAreFound()
        {
            map.Add(HapticMaterialRule.ForTag("No Such Tag", Feeling("stone")));
            map.Add(HapticMaterialRule.ForLayer(29, Feeling("stone")));
            map.Add(HapticMaterialRule.ForTag("", Feeling("stone")));
            With("Rule 1 of Rooms matches a tag that the project does not have");
            With("Rule 2 of Rooms matches a layer that has no name in the project");
            With("Rule 3 of Rooms has an empty condition");
            map.Add(HapticMaterialRule.ForSubmesh(Halves("Vase").sharedMesh, 2, Feeling("stone")));
            With("Rule 4 of Rooms matches submesh 2 of a mesh whose last submesh is 1");
        }

        [Test]
        public void AMaterialOfARuleWithAnUnknownLabelIsFound()
        {
            map.Add(HapticMaterialRule.ForTag("Finish", Feeling("ston")));
            With("ston: the model has no label \"ston\"");
        }

        [Test]
        public void SubmeshesThatCannotBeToldApartAreFound()
        {
            map.Add(HapticMaterialRule.ForSubmesh(null, 0, Feeling("wood")));
            map.Add(HapticMaterialRule.ForSubmesh(null, 1, Feeling("glass")));
            MeshCollider vase = Halves("Vase");
            Assert.That(Texts(), Has.Exactly(1).EqualTo(
                "Vase: felt as wood; glass (rule 1 of \"Rooms\": submesh 0; rule 2 of \"Rooms\": submesh 1)."));
            Assert.That(Texts(), Has.None.Contains("feel like different materials"));
            vase.convex = true;
            With("Vase: the submeshes feel like different materials, but a convex collider");
            vase.convex = false;
            vase.sharedMesh!.UploadMeshData(true);
            With("Vase: the submeshes feel like different materials, but the mesh is not readable");
        }

        [Test]
        public void AMaskWithoutTextureCoordinatesIsFoundWithTheReason()
        {
            HapticMaskMap mask = Mask();
            mask.SetPixels(1, 1, new[] { new Color32(255, 0, 0, 0) }, true);
            map.Add(HapticMaterialRule.ForName("Masked*", Feeling("wood")));
            map.Rules[0].Mask = mask;
            Box("Masked Box");
            With("Masked Box: the mask Mask has no effect, because only a mesh collider");
            MeshCollider mesh = Halves("Masked Mesh");
            With("Masked Mesh: the mask Mask has no effect, because its mesh has no first texture coordinates");
            mesh.sharedMesh!.uv = new Vector2[6];
            Assert.That(Texts(), Has.None.Contains("Masked Mesh: the mask"));
            mesh.convex = true;
            With("Masked Mesh: the mask Mask has no effect, because a convex mesh collider");
            mesh.convex = false;
            mesh.sharedMesh.UploadMeshData(true);
            With("Masked Mesh: the mask Mask has no effect, because its mesh is not readable");
        }

        [Test]
        public void AMaskIsBakedWithOneUndoAndIsAFindingAgainWhenItsTextureChanges()
        {
            HapticMaskMap mask = Mask();
            map.Add(HapticMaterialRule.ForName("Masked*", Feeling("wood")));
            map.Rules[0].Mask = mask;
            Halves("Masked").sharedMesh!.uv = new Vector2[6];
            With("Mask has no texture to bake");
            var texture = new Texture2D(4, 2, TextureFormat.RGBA32, false) { name = "Paint" };
            texture.SetPixels32(Enumerable.Range(0, 8)
                .Select(texel => new Color32((byte)(texel * 10), 0, 0, 255)).ToArray());
            texture.Apply(false);
            mask.Texture = texture;
            Undo.IncrementCurrentGroup();
            With("Mask is not baked").Repairs.Single(repair => repair.Caption == "Bake").Act();
            Assert.That(mask.IsBaked, Is.True);
            Assert.That((mask.Width, mask.Height), Is.EqualTo((4, 2)));
            Assert.That(Texts(), Has.None.Contains("baked"));
            Undo.PerformUndo();
            Assert.That(mask.IsBaked, Is.False);
            With("Mask is not baked").Repairs.Single().Act();
            texture.SetPixels32(new Color32[8]);
            texture.Apply(false);
            With("has changed since the mask was baked");
            texture.Apply(false, true);
            With("the texture Paint is not readable, so its changes cannot be baked");
            Object.DestroyImmediate(texture);
        }

        [Test]
        public void AMapWithoutRulesIsFound() => With("The map Rooms has no rule and no default");

        /// <summary>The only finding that contains a text.</summary>
        private static Finding With(string part)
        {
            IReadOnlyList<Finding> found = Findings().Where(finding => finding.Text.Contains(part)).ToArray();
            Assert.That(found, Has.Count.EqualTo(1), string.Join("\n", Texts()));
            return found[0];
        }

        private static HapticMaskMap Mask()
        {
            HapticMaskMap mask = ScriptableObject.CreateInstance<HapticMaskMap>();
            mask.name = "Mask";
            return mask;
        }

        private MeshCollider Halves(string name)
        {
            var mesh = new Mesh
            {
                vertices = new[]
                {
                    new Vector3(-0.1f, 0f, -0.1f), new Vector3(-0.1f, 0f, 0.1f), new Vector3(0f, 0f, -0.1f),
                    new Vector3(0f, 0f, 0.1f), new Vector3(0.1f, 0f, -0.1f), new Vector3(0.1f, 0f, 0.1f),
                },
                subMeshCount = 2,
            };
            mesh.SetTriangles(new[] { 0, 1, 3, 0, 3, 2 }, 0);
            mesh.SetTriangles(new[] { 2, 3, 5, 2, 5, 4 }, 1);
            MeshCollider collider = Make(name).AddComponent<MeshCollider>();
            collider.sharedMesh = mesh;
            return collider;
        }
    }
}
