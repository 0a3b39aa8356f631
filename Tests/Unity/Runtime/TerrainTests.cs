#nullable enable
using System.Collections;
using System.Collections.Generic;
using System.Linq;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;

namespace HaptoFlow.Tests
{
    /// <summary>A terrain has the materials of its layers, blended as they are painted at the touched place.</summary>
    public sealed class TerrainTests : MapTest
    {
        private const int Resolution = 17;

        private TerrainLayer[] layers = { };
        private TerrainCollider terrain = null!;

        [UnityTest]
        public IEnumerator HalfWoodAndHalfCorduroyGiveTwoLabelsOfEqualWeight()
        {
            Terrain("grass", "rock");
            AddRule(0, "wood");
            AddRule(1, "corduroy");
            Paint((x, z) => new[] { 1f - x, x });
            HapticStylus middle = Resting();
            HapticStylus left = Resting(-0.45f);
            HapticStylus quarter = Resting(-0.25f, 0.1f);
            yield return Frames(2);
            Assert.That(Felt(middle).Select(each => each.Label), Is.EquivalentTo(new[] { "wood", "corduroy" }));
            Assert.That(Felt(middle).Select(each => each.Weight), Is.All.EqualTo(0.5f).Within(0.01f));
            Assert.That(WeightOf(left, "wood"), Is.EqualTo(0.95f).Within(0.01f));
            Assert.That(Felt(quarter)[0].Label, Is.EqualTo("wood"), "labels are sorted by weight");
            Assert.That(WeightOf(quarter, "corduroy"), Is.EqualTo(0.25f).Within(0.01f));
            Assert.That(quarter.Contact.Explain(), Is.EqualTo("rule 1 of \"Project\": terrain layer \"grass\""));
        }

        [UnityTest]
        public IEnumerator TheFourHeaviestOfSixLayersAreKeptWithWeightsThatSumToOne()
        {
            string[] labels = { "wood", "stone", "glass", "fur", "rubber", "jute" };
            Terrain("a", "b", "c", "d", "e", "f");
            for (int layer = 0; layer < labels.Length; ++layer)
            {
                AddRule(layer, labels[layer]);
            }
            Paint((x, z) => new[] { 0.05f, 0.3f, 0.1f, 0.25f, 0.02f, 0.28f });
            HapticStylus stylus = Resting();
            yield return Frames(2);
            List<(string Label, float Weight)> felt = Felt(stylus);
            Assert.That(felt.Select(each => each.Label), Is.EqualTo(new[] { "stone", "jute", "fur", "glass" }));
            Assert.That(felt.Sum(each => each.Weight), Is.EqualTo(1f).Within(1e-4f));
        }

        [UnityTest]
        public IEnumerator LayersOfOneMaterialMergeAndALayerWithoutMaterialWeakensTheRest()
        {
            Terrain("grass", "moss", "water");
            HapticMaterial soft = Feeling("fur", material => material.Strength = 0.8f);
            Map.Add(HapticMaterialRule.ForTerrainLayer(layers[0], soft));
            Map.Add(HapticMaterialRule.ForTerrainLayer(layers[1], soft));
            Paint((x, z) => new[] { 0.25f, 0.25f, 0.5f });
            HapticStylus stylus = Resting();
            yield return Frames(2);
            Assert.That(Felt(stylus), Has.Count.EqualTo(1));
            Assert.That(WeightOf(stylus, "fur"), Is.EqualTo(1f));
            ResolvedMaterial felt = MappedColliders.Resolve(terrain)!.At(PlaceOf(stylus), HapticSession.Current);
            Assert.That(felt.Strength, Is.EqualTo(0.4f).Within(0.01f), "the other half has no material");
        }

        [UnityTest]
        public IEnumerator ScaleToneAndStiffnessOfABlendLieBetweenThoseOfItsMaterials()
        {
            Terrain("grass", "rock");
            Map.Add(HapticMaterialRule.ForTerrainLayer(layers[0], Feeling("wood", material =>
            {
                material.FeatureScale = 0.5f;
                material.ToneDbPerOctave = -4f;
                material.StiffnessNewtonsPerMetre = 200f;
            })));
            Map.Add(HapticMaterialRule.ForTerrainLayer(layers[1], Feeling("stone", material =>
            {
                material.FeatureScale = 2f;
                material.ToneDbPerOctave = 2f;
                material.StiffnessNewtonsPerMetre = 600f;
            })));
            Paint((x, z) => new[] { 0.5f, 0.5f });
            HapticStylus stylus = Resting();
            yield return Frames(2);
            ResolvedMaterial felt = MappedColliders.Resolve(terrain)!.At(PlaceOf(stylus), HapticSession.Current);
            Assert.That(felt.FeatureScale, Is.EqualTo(1f).Within(0.02f), "by ratio");
            Assert.That(felt.ToneDbPerOctave, Is.EqualTo(-1f).Within(0.05f));
            Assert.That(felt.StiffnessNewtonsPerMetre, Is.EqualTo(400.0).Within(4.0));
            Assert.That(stylus.Contact.ForceNewtons, Is.EqualTo(0.4f).Within(0.02f));
        }

        [UnityTest]
        public IEnumerator WeightsOfALargeTerrainAreStoredAtALowerResolution()
        {
            Terrain("a", "b", "c", "d", "e");
            terrain.terrainData!.alphamapResolution = 2048;
            AddRule(0, "wood");
            AddRule(1, "stone");
            // 21 MB at one byte per layer and texel; a fine chessboard of the first two layers on the right half.
            var map = new float[2048, 2048, layers.Length];
            for (int z = 0; z < 2048; ++z)
            {
                for (int x = 0; x < 2048; ++x)
                {
                    map[z, x, x < 1024 ? 0 : (x + z) % 2] = 1f;
                }
            }
            terrain.terrainData.SetAlphamaps(0, 0, map);
            HapticStylus left = Resting(-0.3f);
            HapticStylus right = Resting(0.3f);
            yield return Frames(2);
            Assert.That(FeltAlone(left), Is.EqualTo("wood"));
            Assert.That(WeightOf(right, "stone"), Is.EqualTo(0.5f).Within(0.01f));
        }

        [UnityTest]
        public IEnumerator TerrainDataDestroyedUnderTheTipEndsTheTouchWithoutAnError()
        {
            Terrain("grass", "rock");
            AddRule(0, "wood");
            AddRule(1, "stone");
            HapticStylus stylus = Resting();
            yield return Frames(2);
            Assert.That(stylus.IsTouching, Is.True);
            UnityEngine.Object.DestroyImmediate(terrain.terrainData!);
            yield return Frames(2);
            Assert.That(stylus.IsTouching, Is.False);
        }

        [UnityTest]
        public IEnumerator ATerrainWithoutLayersMatchesTheRulesForItsObject()
        {
            Terrain();
            Map.Add(HapticMaterialRule.ForName("Ground", Feeling("stone")));
            return Feels((0f, "stone"));
        }

        private TouchedPlace PlaceOf(HapticStylus stylus) => new TouchedPlace(
            terrain, (stylus.Contact.Point - terrain.transform.position).ToDouble(), null);

        private void AddRule(int layer, string label) =>
            Map.Add(HapticMaterialRule.ForTerrainLayer(layers[layer], Feeling(label)));

        /// <summary>A flat square of 1 m around the origin.</summary>
        private void Terrain(params string[] names)
        {
            layers = names.Select(name => Keep(new TerrainLayer { name = name })).ToArray();
            TerrainData data = Keep(new TerrainData());
            data.heightmapResolution = 33;
            data.size = new Vector3(1f, 0.1f, 1f);
            data.alphamapResolution = Resolution;
            data.terrainLayers = layers;
            GameObject owner = UnityEngine.Terrain.CreateTerrainGameObject(data);
            owner.name = "Ground";
            owner.transform.position = new Vector3(-0.5f, 0f, -0.5f);
            Keep(owner);
            terrain = owner.GetComponent<TerrainCollider>();
        }

        /// <param name="weights">Weights of the layers at a place on the terrain, with coordinates from 0 to 1.</param>
        private void Paint(System.Func<float, float, float[]> weights)
        {
            var map = new float[Resolution, Resolution, layers.Length];
            for (int z = 0; z < Resolution; ++z)
            {
                for (int x = 0; x < Resolution; ++x)
                {
                    float[] here = weights(x / (Resolution - 1f), z / (Resolution - 1f));
                    for (int layer = 0; layer < layers.Length; ++layer)
                    {
                        map[z, x, layer] = here[layer];
                    }
                }
            }
            terrain.terrainData!.SetAlphamaps(0, 0, map);
        }
    }
}
