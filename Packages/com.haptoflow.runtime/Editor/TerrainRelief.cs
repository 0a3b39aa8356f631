#nullable enable
using System;
using System.Linq;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Takes a relief from the normal map of a terrain's layer, so that it lies where the layer's texture is
    /// seen. Main thread.</summary>
    internal static class TerrainRelief
    {
        public const string Caption = "Take from the Terrain's Layer";

        private const float SameShare = 1e-3f;

        // Few enough for a large terrain with many layers.
        private const int RowsAtOnce = 64;

        /// <summary>The terrain that a surface is on; null for none.</summary>
        public static TerrainCollider? TerrainOf(HapticSurface surface) =>
            surface.TryGetComponent(out TerrainCollider terrain) && terrain.terrainData != null ? terrain : null;

        /// <summary>Bakes the layer that covers most of a terrain into the surface's relief, or into a new asset beside
        /// the layer, as one step of undo.</summary>
        /// <returns>Why nothing was baked, as a sentence; null when all is well.</returns>
        public static string? Take(HapticSurface surface, TerrainCollider terrain)
        {
            TerrainLayer? layer = WidestLayer(terrain.terrainData!);
            if (layer == null)
            {
                return $"{surface.name} has no terrain layer. Paint one with a normal map.";
            }
            string? problem = Bake(layer, out BakedHeights heights);
            if (problem == null)
            {
                ReliefBake.Write(surface, layer, heights);
            }
            return problem;
        }

        /// <summary>Bakes a layer into a relief. Can be undone.</summary>
        /// <returns>Why nothing was baked, as a sentence; null when all is well.</returns>
        public static string? Take(HapticRelief relief, TerrainLayer layer)
        {
            string? problem = Bake(layer, out BakedHeights heights);
            if (problem == null)
            {
                ReliefBake.Write(relief, heights);
            }
            return problem;
        }

        /// <summary>True where a relief lies on a terrain as the texture of a layer does.</summary>
        public static bool Fits(HapticRelief relief, TerrainLayer layer)
        {
            Vector2 size = layer.tileSize;
            return (relief.SizeMetres - size).magnitude <= SameShare * size.magnitude &&
                IsSame(relief.Offset.x, layer.tileOffset.x / size.x) &&
                IsSame(relief.Offset.y, layer.tileOffset.y / size.y);
        }

        /// <summary>A whole map aside lies the same.</summary>
        private static bool IsSame(float one, float other) =>
            Math.Abs(Math.IEEERemainder(one - other, 1.0)) <= SameShare;

        private static string? Bake(TerrainLayer layer, out BakedHeights heights)
        {
            heights = default;
            Texture2D? map = layer.normalMapTexture;
            if (map == null)
            {
                return $"The layer {layer.name} has no normal map: it has no heights.";
            }
            Vector2 size = layer.tileSize;
            if (!(size.x > 0f && size.y > 0f))
            {
                return FormattableString.Invariant(
                    $"The layer {layer.name} has a tile size of {size.x} x {size.y} m. Give it a size above 0.");
            }
            bool repeats = map.wrapMode == TextureWrapMode.Repeat;
            try
            {
                heights = ReliefBake.BakeNormals(map, layer.normalScale, size, repeats);
            }
            catch (HaptoFlowException refusal)
            {
                return $"The map {map.name} of {layer.name} was not baked: {refusal.Message}.";
            }
            (heights.SizeMetres, heights.Repeats) = (size, repeats);
            heights.Offset = new Vector2(layer.tileOffset.x / size.x, layer.tileOffset.y / size.y);
            return heights.AreEven ? $"The map {map.name} of {layer.name} is even: it has no heights." : null;
        }

        private static TerrainLayer? WidestLayer(TerrainData terrain)
        {
            TerrainLayer[] layers = terrain.terrainLayers;
            var weights = new double[layers.Length];
            int resolution = layers.Length > 0 ? terrain.alphamapResolution : 0;
            for (int row = 0; row < resolution; row += RowsAtOnce)
            {
                float[,,] strip = terrain.GetAlphamaps(0, row, resolution, Math.Min(RowsAtOnce, resolution - row));
                int layer = 0;
                // The layers are the array's last, fastest index.
                foreach (float weight in strip)
                {
                    weights[layer] += weight;
                    layer = (layer + 1) % layers.Length;
                }
            }
            return layers.Length == 0 ? null : layers[Array.IndexOf(weights, weights.Max())];
        }
    }
}
