#nullable enable
using System.Collections;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;

namespace HaptoFlow.Tests
{
    /// <summary>Several materials on one mesh, distinguished by the touched triangle.</summary>
    public sealed class SubmeshTests : MapTest
    {
        [UnityTest]
        public IEnumerator EachSubmeshHasTheMaterialOfItsRule()
        {
            FinishLoading();
            MeshCollider mesh = TwoHalves();
            Map.Add(HapticMaterialRule.ForSubmesh(mesh.sharedMesh, 0, Feeling("wood")));
            Map.Add(HapticMaterialRule.ForSubmesh(null, 1, Feeling("glass")));
            HapticStylus left = Resting(-0.05f);
            HapticStylus right = Resting(0.05f);
            yield return Frames(2);
            Assert.That(FeltAlone(left), Is.EqualTo("wood"));
            Assert.That(FeltAlone(right), Is.EqualTo("glass"));
            Assert.That(right.Contact.Explain(), Is.EqualTo("rule 2 of \"Project\": submesh 1"));
        }

        [UnityTest]
        public IEnumerator EachSubmeshIsMatchedByItsRendererMaterial()
        {
            FinishLoading();
            MeshCollider mesh = TwoHalves();
            Material oak = Paint("Oak");
            Material ice = Paint("Ice");
            mesh.gameObject.AddComponent<MeshRenderer>().sharedMaterials = new[] { oak, ice };
            Map.Add(HapticMaterialRule.ForRendererMaterial(ice, Feeling("glass")));
            Map.Add(HapticMaterialRule.ForRendererMaterial(oak, Feeling("wood")));
            HapticStylus left = Resting(-0.05f);
            HapticStylus right = Resting(0.05f);
            yield return Frames(2);
            Assert.That(FeltAlone(left), Is.EqualTo("wood"));
            Assert.That(FeltAlone(right), Is.EqualTo("glass"));
        }

        [UnityTest]
        public IEnumerator CrossingTheBorderOfTwoSubmeshesChangesTheMaterialWithinOneTouch()
        {
            FinishLoading();
            MeshCollider mesh = TwoHalves();
            Map.Add(HapticMaterialRule.ForSubmesh(mesh.sharedMesh, 0, Feeling("wood")));
            Map.Add(HapticMaterialRule.ForSubmesh(mesh.sharedMesh, 1, Feeling("glass")));
            HapticStylus stylus = StylusAlong(seconds => new Vector3(-0.05f + 0.2f * (float)seconds, 0.001f, 0f));
            var log = new TouchLog(stylus);
            for (int frame = 0; frame < 50; ++frame)
            {
                yield return null;
                if (frame > 0)
                {
                    string expected = stylus.transform.position.x < 0f ? "wood" : "glass";
                    Assert.That(FeltAlone(stylus), Is.EqualTo(expected), $"frame {frame}");
                }
            }
            Assert.That(stylus.transform.position.x, Is.GreaterThan(0.02f));
            Assert.That(log.Began, Is.EqualTo(1));
        }

        [UnityTest]
        public IEnumerator ASubmeshWithoutMaterialIsSilentAndItsNeighbourIsNot()
        {
            FinishLoading();
            MeshCollider mesh = TwoHalves();
            Map.Add(HapticMaterialRule.ForSubmesh(mesh.sharedMesh, 0, null));
            Map.Add(HapticMaterialRule.ForSubmesh(mesh.sharedMesh, 1, Feeling("sandpaper")));
            Output(out _);
            float side = -1f;
            HapticStylus stylus = StylusAlong(seconds => new Vector3(
                side * (0.05f + 0.03f * (float)System.Math.Sin(8.0 * seconds)), 0.001f, 0f));
            yield return Frames(30);
            Assert.That(stylus.TryGetStatistics(out VoiceStatistics silent), Is.True);
            Assert.That(silent.Inferences, Is.Zero, "the left submesh has no material");
            side = 1f;
            yield return Frames(30);
            Assert.That(stylus.TryGetStatistics(out VoiceStatistics sounding), Is.True);
            Assert.That(sounding.Inferences, Is.GreaterThan(2UL));
        }

        [UnityTest]
        public IEnumerator AnUnreadableMeshHasTheMaterialOfItsFirstSubmesh()
        {
            FinishLoading();
            MeshCollider mesh = TwoHalves();
            mesh.sharedMesh!.UploadMeshData(true);
            Map.Add(HapticMaterialRule.ForSubmesh(mesh.sharedMesh, 0, Feeling("wood")));
            Map.Add(HapticMaterialRule.ForSubmesh(mesh.sharedMesh, 1, Feeling("glass")));
            HapticStylus right = Resting(0.05f);
            yield return Frames(2);
            Assert.That(FeltAlone(right), Is.EqualTo("wood"));
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
