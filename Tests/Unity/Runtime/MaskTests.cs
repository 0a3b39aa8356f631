#nullable enable
using System.Collections;
using System.Linq;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;

namespace HaptoFlow.Tests
{
    /// <summary>Materials from a mask at the texture coordinates of the touched place.</summary>
    public sealed class MaskTests : MapTest
    {
        private MeshCollider floor = null!;

        [UnityTest]
        public IEnumerator AChannelBlendsItsMaterialByBrightness()
        {
            Rule("wood", Glass(4, 1, 0, 85, 170, 255));
            yield return Feels((-0.075f, "wood"), (0.075f, "glass"));
            HapticStylus third = Resting(-0.025f);
            HapticStylus between = Resting(0f);
            yield return Frames(2);
            Assert.That(WeightOf(third, "glass"), Is.EqualTo(1f / 3f).Within(0.01f));
            Assert.That(WeightOf(third, "wood"), Is.EqualTo(2f / 3f).Within(0.01f));
            Assert.That(WeightOf(between, "glass"), Is.EqualTo(0.5f).Within(0.01f), "half way between two texels");
        }

        [UnityTest]
        public IEnumerator AHapticSurfaceCanHaveAMask()
        {
            var surface = Floor().gameObject.AddComponent<HapticSurface>();
            surface.Material.Label = "wood";
            surface.Mask = Glass(2, 1, 0, 255);
            return Feels((-0.05f, "wood"), (0.05f, "glass"));
        }

        [Test]
        public void StrengthAndFeatureScaleFollowTheirChannels()
        {
            HapticMaskMap mask = Mask(2, 1, 0, 255);
            mask.Red.SetFactor(MaskChannelUse.Strength, 0.25f, 1f);
            mask.Green.SetFactor(MaskChannelUse.FeatureScale, 0.5f, 2f);
            Rule("wood", mask);
            Assert.That(At(mask, -0.05f).Strength, Is.EqualTo(0.25f).Within(0.01f));
            Assert.That(At(mask, -0.05f).FeatureScale, Is.EqualTo(0.5f).Within(0.01f));
            Assert.That(At(mask, 0.05f).Strength, Is.EqualTo(1f).Within(0.01f));
            Assert.That(At(mask, 0.05f).FeatureScale, Is.EqualTo(2f).Within(0.01f));
        }

        [UnityTest]
        public IEnumerator ChannelsWithASumAboveOneReplaceTheMaterialBelow()
        {
            HapticMaskMap mask = Glass(1, 1, 255);
            mask.Green.SetMaterial(Feeling("fur"));
            Rule("wood", mask);
            HapticStylus stylus = Resting();
            yield return Frames(2);
            Assert.That(Felt(stylus).Select(each => each.Label), Is.EquivalentTo(new[] { "glass", "fur" }));
            Assert.That(Felt(stylus).Sum(each => each.Weight), Is.EqualTo(1f).Within(1e-4f));
        }

        [UnityTest]
        public IEnumerator AMaskWithoutAMaterialBelowIsFeltWhereItsChannelsHaveOne()
        {
            Floor();
            Map.Add(HapticMaterialRule.ForName("Floor", null));
            Map.Rules[0].Mask = Glass(2, 1, 0, 255);
            return Feels((-0.05f, ""), (0.05f, "glass"));
        }

        [UnityTest]
        public IEnumerator ARepeatedMaskRepeatsAndAClampedOneDoesNot()
        {
            HapticMaskMap mask = Glass(2, 1, 0, 255);
            mask.Tiling = new Vector2(2f, 1f);
            Rule("wood", mask);
            yield return Feels((-0.025f, "glass"), (0.025f, "wood"), (0.075f, "glass"));
            mask.SetPixels(2, 1, Grey(0, 255), false);
            yield return Feels((0.025f, "glass"));
        }

        [UnityTest]
        public IEnumerator WithoutATextureCoordinateTheMaterialBelowTheMaskIsFelt()
        {
            Bare();
            Map.Add(HapticMaterialRule.ForName("Plank", Feeling("wood")));
            Map.Rules[0].Mask = Glass(1, 1, 255);
            return Feels((0f, "wood"));
        }

        [Test]
        public void ExtremeNumbersInAMaskGiveValidResults()
        {
            HapticMaskMap mask = Mask(2, 2, 0, 255, 255, 0);
            mask.Red.SetMaterial(null);
            mask.Green.SetFactor(MaskChannelUse.Strength, float.NaN, float.PositiveInfinity);
            mask.Blue.SetFactor(MaskChannelUse.FeatureScale, -5f, 1e30f);
            Rule("wood", mask);
            foreach (float strange in new[] { float.NaN, float.PositiveInfinity, -1e30f, 1e30f })
            {
                mask.Tiling = new Vector2(strange, 1f);
                mask.Offset = new Vector2(0f, strange);
                ResolvedMaterial felt = At(mask, 0.03f);
                Assert.That(felt.Strength, Is.InRange(0f, 1f));
                Assert.That(felt.FeatureScale, Is.InRange(0.25f, 4f));
            }
            Assert.That(() => mask.SetPixels(2, 2, Grey(0), true), Throws.ArgumentException);
        }

        private static Color32[] Grey(params byte[] values) =>
            values.Select(value => new Color32(value, value, value, value)).ToArray();

        private HapticMaskMap Mask(int width, int height, params byte[] values)
        {
            HapticMaskMap mask = Keep(ScriptableObject.CreateInstance<HapticMaskMap>());
            mask.SetPixels(width, height, Grey(values), true);
            return mask;
        }

        /// <summary>A mask whose red channel is glass.</summary>
        private HapticMaskMap Glass(int width, int height, params byte[] values)
        {
            HapticMaskMap mask = Mask(width, height, values);
            mask.Red.SetMaterial(Feeling("glass"));
            return mask;
        }

        private void Rule(string label, HapticMaskMap mask)
        {
            Floor();
            Map.Add(HapticMaterialRule.ForName("Floor", Feeling(label)));
            Map.Rules[0].Mask = mask;
        }

        /// <summary>The material that the mask gives with the rule's material at a place on the floor.</summary>
        private ResolvedMaterial At(HapticMaskMap mask, float x)
        {
            Physics.SyncTransforms();
            var ray = new Ray(new Vector3(x, 0.1f, 0.01f), Vector3.down);
            Assert.That(floor.Raycast(ray, out RaycastHit hit, 1f), Is.True);
            var place = new TouchedPlace(floor, default, hit);
            bool isFelt = mask.TryFeel(
                place, ResolvedMaterial.Of(Map.Rules[0].Material, HapticSession.Current, floor), HapticSession.Current, floor,
                out ResolvedMaterial felt);
            Assert.That(isFelt, Is.True);
            return felt;
        }

        /// <summary>20 x 20 cm at y = 0, with texture coordinates from 0 to 1 along x and z.</summary>
        private MeshCollider Floor()
        {
            Mesh mesh = Keep(new Mesh
            {
                vertices = new[]
                {
                    new Vector3(-0.1f, 0f, -0.1f), new Vector3(-0.1f, 0f, 0.1f), new Vector3(0.1f, 0f, 0.1f),
                    new Vector3(0.1f, 0f, -0.1f),
                },
                uv = new[] { new Vector2(0f, 0f), new Vector2(0f, 1f), new Vector2(1f, 1f), new Vector2(1f, 0f) },
                triangles = new[] { 0, 1, 2, 0, 2, 3 },
            });
            floor = Make("Floor").AddComponent<MeshCollider>();
            floor.sharedMesh = mesh;
            return floor;
        }
    }

    /// <summary>Several materials on one mesh, distinguished by the touched triangle.</summary>
    public sealed class SubmeshTests : MapTest
    {
        [UnityTest]
        public IEnumerator EachSubmeshHasTheMaterialOfItsRule()
        {
            MeshCollider mesh = TwoHalves();
            Map.Add(HapticMaterialRule.ForSubmesh(mesh.sharedMesh, 0, Feeling("wood")));
            Map.Add(HapticMaterialRule.ForSubmesh(null, 1, Feeling("glass")));
            yield return Feels((-0.05f, "wood"));
            HapticStylus right = Resting(0.05f);
            yield return Frames(2);
            Assert.That(FeltAlone(right), Is.EqualTo("glass"));
            Assert.That(right.Contact.Explain(), Is.EqualTo("rule 2 of \"Project\": submesh 1"));
        }

        [UnityTest]
        public IEnumerator EachSubmeshIsMatchedByItsRendererMaterial()
        {
            MeshCollider mesh = TwoHalves();
            Material oak = Paint("Oak");
            Material ice = Paint("Ice");
            mesh.gameObject.AddComponent<MeshRenderer>().sharedMaterials = new[] { oak, ice };
            Map.Add(HapticMaterialRule.ForRendererMaterial(ice, Feeling("glass")));
            Map.Add(HapticMaterialRule.ForRendererMaterial(oak, Feeling("wood")));
            return Feels((-0.05f, "wood"), (0.05f, "glass"));
        }

        [UnityTest]
        public IEnumerator AnUnreadableMeshHasTheMaterialOfItsFirstSubmesh()
        {
            MeshCollider mesh = TwoHalves();
            mesh.sharedMesh!.UploadMeshData(true);
            Map.Add(HapticMaterialRule.ForSubmesh(mesh.sharedMesh, 0, Feeling("wood")));
            Map.Add(HapticMaterialRule.ForSubmesh(mesh.sharedMesh, 1, Feeling("glass")));
            return Feels((0.05f, "wood"));
        }

        /// <summary>A floor of 20 x 20 cm at y = 0: submesh 0 left of x = 0, submesh 1 right of it.</summary>
        private MeshCollider TwoHalves()
        {
            var mesh = Keep(new Mesh
            {
                vertices = new[]
                {
                    new Vector3(-0.1f, 0f, -0.1f), new Vector3(-0.1f, 0f, 0.1f), new Vector3(0f, 0f, -0.1f),
                    new Vector3(0f, 0f, 0.1f), new Vector3(0.1f, 0f, -0.1f), new Vector3(0.1f, 0f, 0.1f),
                },
                subMeshCount = 2,
            });
            mesh.SetTriangles(new[] { 0, 1, 3, 0, 3, 2 }, 0);
            mesh.SetTriangles(new[] { 2, 3, 5, 2, 5, 4 }, 1);
            MeshCollider collider = Make("Halves").AddComponent<MeshCollider>();
            collider.sharedMesh = mesh;
            return collider;
        }
    }
}
