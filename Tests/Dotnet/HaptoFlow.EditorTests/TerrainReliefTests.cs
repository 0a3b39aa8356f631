using System;
using System.Linq;
using HaptoFlow.Editor;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

namespace HaptoFlow.EditorTests
{
    /// <summary>Reliefs that are taken from the normal map of a terrain's layer.</summary>
    public sealed class TerrainReliefTests : EditorTest
    {
        [Test]
        public void ALayerGivesTheHeightsOfItsNormalMapWhereItsTextureIsSeen()
        {
            TerrainLayer layer = Layer("Sand");
            layer.tileOffset = new Vector2(0.5f, 3f);
            var relief = ScriptableObject.CreateInstance<HapticRelief>();
            relief.Tiling = new Vector2(3f, 3f);
            Assert.That(TerrainRelief.Take(relief, layer), Is.Null);
            Assert.That(relief.SizeMetres, Is.EqualTo(new Vector2(2f, 4f)), "the tile size");
            Assert.That((relief.Offset.x, relief.Offset.y), Is.EqualTo((0.25f, 0.75f)), "in lengths of the map");
            Assert.That((relief.Tiling, relief.Repeats), Is.EqualTo((new Vector2(1f, 1f), true)));
            Assert.That(relief.DepthMillimetres, Is.EqualTo(4f).Within(0.1f));
            for (int column = 0; column < 64; ++column)
            {
                Assert.That(relief.HeightAt(column, 1),
                    Is.EqualTo(0.5 + 0.5 * Math.Sin(2.0 * Math.PI * column / 64.0)).Within(0.02), $"column {column}");
            }
            layer.normalScale = 0.5f;
            TerrainRelief.Take(relief, layer);
            Assert.That(relief.DepthMillimetres, Is.EqualTo(2f).Within(0.05f));
        }

        [TestCase("no map", "The layer Sand has no normal map: it has no heights.")]
        [TestCase("no size", "The layer Sand has a tile size of 0 x 4 m. Give it a size above 0.")]
        [TestCase("a scale of 0", "The map Dunes of Sand is even: it has no heights.")]
        [TestCase("a size that is no number", "The layer Sand has a tile size of NaN x 4 m. Give it a size above 0.")]
        public void WhatALayerLacksIsSaidAndChangesNothing(string what, string said)
        {
            TerrainLayer layer = Layer("Sand");
            layer.normalMapTexture = what == "no map" ? null : layer.normalMapTexture;
            layer.tileSize = new Vector2(
                what == "no size" ? 0f : what == "a size that is no number" ? float.NaN : 2f, 4f);
            layer.normalScale = what == "a scale of 0" ? 0f : 1f;
            var relief = ScriptableObject.CreateInstance<HapticRelief>();
            Assert.That(TerrainRelief.Take(relief, layer), Is.EqualTo(said));
            Assert.That(relief.IsBaked, Is.False);
        }

        [Test]
        public void ASurfaceOnATerrainTakesTheLayerThatCoversMostOfItWithUndo()
        {
            TerrainLayer[] layers = { Layer("Grass"), Layer("Sand") };
            layers[1].tileSize = new Vector2(1f, 1f);
            AssetDatabase.CreateAsset(layers[1], Folder + "/Sand.terrainlayer");
            HapticSurface ground = Ground(layers, out TerrainData data);
            EditorScreen.Press("Take from the Terrain's Layer");
            Assert.That(InspectorTests.Draw(ground).Select(item => item.Label),
                Has.None.EqualTo("Take from the Object's Material"));
            Assert.That(ground.Relief!.SizeMetres.x, Is.EqualTo(2f), "the first layer covers a new terrain");
            Undo.PerformUndo();
            Assert.That(ground.Relief == null, Is.True);
            var weights = new float[16, 16, 2];
            for (int place = 0; place < 256; ++place)
            {
                weights[place / 16, place % 16, place % 16 < 6 ? 0 : 1] = 1f;
            }
            data.SetAlphamaps(0, 0, weights);
            Assert.That(TerrainRelief.Take(ground, ground.GetComponent<TerrainCollider>()), Is.Null);
            Assert.That(ground.Relief!.SizeMetres.x, Is.EqualTo(1f));
            Assert.That(AssetDatabase.GetAssetPath(ground.Relief), Is.EqualTo(Folder + "/Sand Relief.asset"));
        }

        [Test]
        public void ATerrainWithoutLayersSaysSo()
        {
            HapticSurface ground = Ground(Array.Empty<TerrainLayer>(), out _);
            EditorScreen.Press("Take from the Terrain's Layer");
            UnityEditor.Editor inspector = UnityEditor.Editor.CreateEditor(new Object[] { ground });
            EditorScreen.Draw(inspector.OnInspectorGUI);
            Assert.That(EditorScreen.Draw(inspector.OnInspectorGUI).Select(item => item.Label),
                Has.Member("Ground has no terrain layer. Paint one with a normal map."));
        }

        [Test]
        public void ADroppedLayerIsTaken()
        {
            var relief = ScriptableObject.CreateInstance<HapticRelief>();
            EditorScreen.Enter("Take from a Layer", Layer("Sand"));
            InspectorTests.Draw(relief);
            Assert.That(relief.SizeMetres.y, Is.EqualTo(4f));
        }

        /// <summary>A layer of 2 x 4 m with one wave of 2 mm along it.</summary>
        internal static TerrainLayer Layer(string name)
        {
            var map = new Texture2D(64, 2, TextureFormat.RGBA32, false) { name = "Dunes" };
            map.SetPixels(Enumerable.Range(0, 128).Select(texel =>
            {
                double slope = 0.002 * 2.0 * Math.PI / 2.0 * Math.Cos(2.0 * Math.PI * (texel % 64) / 64.0);
                return new Color((float)(0.5 - 0.5 * slope / Math.Sqrt(1.0 + slope * slope)), 0.5f, 1f, 1f);
            }).ToArray());
            return new TerrainLayer { name = name, normalMapTexture = map, tileSize = new Vector2(2f, 4f) };
        }

        private HapticSurface Ground(TerrainLayer[] layers, out TerrainData data)
        {
            data = new TerrainData { terrainLayers = layers };
            HapticSurface ground = Make("Ground").AddComponent<HapticSurface>();
            ground.gameObject.AddComponent<TerrainCollider>().terrainData = data;
            return ground;
        }
    }

    /// <summary>What Check Scene says about reliefs of terrain layers.</summary>
    public sealed class TerrainReliefCheckTests : SceneCheckTest
    {
        [Test]
        public void AReliefThatDoesNotLieAsItsLayerDoesIsMentioned()
        {
            TerrainLayer layer = TerrainReliefTests.Layer("Sand");
            layer.tileSize = new Vector2(0.2f, 0.2f);
            layer.tileOffset = new Vector2(0.1f, 0f);
            HapticMaterialMap map = CreateMap();
            map.Add(HapticMaterialRule.ForTerrainLayer(layer, Feeling("stone")));
            var relief = ScriptableObject.CreateInstance<HapticRelief>();
            relief.name = "Dunes";
            map.Rules[0].Relief = relief;
            ProjectSettings.MaterialMap = map;
            TerrainData data = new TerrainData { terrainLayers = new[] { layer } };
            Make("Ground").AddComponent<TerrainCollider>().terrainData = data;
            TerrainRelief.Take(relief, layer);
            Assert.That(Texts(), Has.None.Contains("does not lie"));
            relief.Offset += new Vector2(1f, 0f);
            Assert.That(Texts(), Has.None.Contains("does not lie"), "a whole map aside");
            layer.tileOffset = new Vector2(0.05f, 0f);
            Assert.That(Texts(), Has.One.Contains("The relief Dunes does not lie where the texture of the terrain " +
                "layer Sand is seen"));
            TerrainRelief.Take(relief, layer);
            layer.tileSize = new Vector2(0.2f, 0.3f);
            Assert.That(Texts(), Has.One.Contains("Dunes does not lie"));
        }
    }
}
