#nullable enable
using System;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.SampleScenes
{
    /// <summary>A terrain of three layers that blend into each other. A separate mesh draws it, because the look of a
    /// terrain created by a script depends on the render pipeline.</summary>
    internal sealed class GardenBed
    {
        private const int Corners = 33;
        private const int Texels = 32;

        /// <summary>The size of the whole, in metres.</summary>
        public static readonly Vector3 Size = new Vector3(0.42f, 0.012f, 0.26f);

        private static readonly (string Layer, string Label, Color Colour)[] Layers =
        {
            ("Gravel", "concrete", new Color(0.6f, 0.6f, 0.58f)),
            ("Turf", "carpet", new Color(0.36f, 0.55f, 0.27f)),
            ("Sand", "sandpaper", new Color(0.87f, 0.76f, 0.5f)),
        };

        private readonly Vector3 corner;
        private readonly Func<Object, Object> keep;

        /// <param name="corner">The position of the terrain's origin, its corner.</param>
        /// <param name="keep">Marks an asset to be destroyed with the scene.</param>
        public GardenBed(Vector3 corner, Func<Object, Object> keep) => (this.corner, this.keep) = (corner, keep);

        public Terrain Build(HapticMaterialMap map, Func<string, HapticMaterial> createMaterial)
        {
            var data = (TerrainData)keep(new TerrainData());
            data.heightmapResolution = Corners;
            data.size = Size;
            data.alphamapResolution = Texels;
            var layers = new TerrainLayer[Layers.Length];
            for (int layer = 0; layer < layers.Length; ++layer)
            {
                layers[layer] = (TerrainLayer)keep(new TerrainLayer { name = Layers[layer].Layer });
                map.Add(HapticMaterialRule.ForTerrainLayer(layers[layer], createMaterial(Layers[layer].Label)));
            }
            data.terrainLayers = layers;
            data.SetHeights(0, 0, Heights());
            data.SetAlphamaps(0, 0, Weights());
            GameObject owner = Terrain.CreateTerrainGameObject(data);
            owner.name = "Garden";
            owner.transform.position = corner;
            var terrain = owner.GetComponent<Terrain>();
            terrain.drawHeightmap = false;
            Draw(owner.transform);
            return terrain;
        }

        /// <summary>The weight of a layer at a position from 0 to 1: gravel on the left, sand on the right, turf
        /// between.</summary>
        private static float Weight(int layer, float x)
        {
            float gravel = Mathf.Clamp01(1.5f - 3f * x);
            float sand = Mathf.Clamp01(3f * x - 1.5f);
            return layer == 0 ? gravel : layer == 2 ? sand : 1f - gravel - sand;
        }

        /// <summary>The height of a low hill, 0 to 1.</summary>
        private static float Height(float x, float z) =>
            (float)(Math.Sin(Math.PI * x) * Math.Sin(Math.PI * z));

        private static float[,] Heights()
        {
            var heights = new float[Corners, Corners];
            for (int z = 0; z < Corners; ++z)
            {
                for (int x = 0; x < Corners; ++x)
                {
                    heights[z, x] = Height(x / (Corners - 1f), z / (Corners - 1f));
                }
            }
            return heights;
        }

        private static float[,,] Weights()
        {
            var weights = new float[Texels, Texels, Layers.Length];
            for (int place = 0; place < Texels * Texels; ++place)
            {
                for (int layer = 0; layer < Layers.Length; ++layer)
                {
                    weights[place / Texels, place % Texels, layer] = Weight(layer, place % Texels / (Texels - 1f));
                }
            }
            return weights;
        }

        private void Draw(Transform terrain)
        {
            var look = new GameObject("Garden Look");
            look.transform.SetParent(terrain, false);
            look.AddComponent<MeshFilter>().sharedMesh = (Mesh)keep(Shapes.Grid(Corners, Corners, (x, z) =>
                Vector3.Scale(Size, new Vector3(x, Height(x, z), z))));
            var renderer = look.AddComponent<MeshRenderer>();
            PipelineMaterial.Paint(renderer, Color.white);
            var pixels = new Color32[Texels];
            for (int x = 0; x < Texels; ++x)
            {
                Color colour = Color.black;
                for (int layer = 0; layer < Layers.Length; ++layer)
                {
                    colour += Weight(layer, x / (Texels - 1f)) * Layers[layer].Colour;
                }
                pixels[x] = colour;
            }
            renderer.material.mainTexture = (Texture2D)keep(Shapes.Picture(Texels, 1, pixels));
        }
    }
}
