#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Numerics;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow
{
    /// <summary>The weights of a terrain's layers at each place: read once into a byte per layer and texel, since
    /// Unity's own query makes garbage. Texels of a large terrain are averaged. Main thread.</summary>
    internal sealed class TerrainWeights
    {
        // Reading a large terrain in strips makes a few megabytes of garbage instead of hundreds.
        private const int RowsAtOnce = 64;
        private const long MaximumBytes = 16L << 20;
        private static readonly Dictionary<TerrainData, TerrainWeights> Known =
            new Dictionary<TerrainData, TerrainWeights>();

        private readonly TerrainData terrain;
        private byte[] texels = Array.Empty<byte>();
        private float[] found = Array.Empty<float>();
        private int sourceResolution;
        private int texelsInOne = 1;
        private int resolution;
        private int layers;
        private bool isStale = true;

        private TerrainWeights(TerrainData terrain) => this.terrain = terrain;

        public static TerrainWeights Of(TerrainData terrain)
        {
            if (!Known.TryGetValue(terrain, out TerrainWeights? weights))
            {
                weights = new TerrainWeights(terrain);
                Known.Add(terrain, weights);
            }
            return weights;
        }

        /// <summary>Reads the terrains of the open scenes where maps are in effect, so that no frame of a touch has
        /// to.</summary>
        public static void ReadScenes()
        {
            if (!MaterialMaps.Any)
            {
                return;
            }
            foreach (TerrainCollider collider in Object.FindObjectsByType<TerrainCollider>(
                FindObjectsInactive.Exclude, FindObjectsSortMode.None))
            {
                if (collider.terrainData != null)
                {
                    Of(collider.terrainData).Read();
                }
            }
        }

        /// <summary>Discards all weights; each terrain is read again at its next query.</summary>
        public static void Forget() => Known.Clear();

        /// <summary>Weights of the layers at a place. The array is reused by the next query.</summary>
        /// <param name="localMetres">Position relative to the terrain's corner.</param>
        public float[] At(Double3 localMetres, Double3 sizeMetres)
        {
            if (isStale)
            {
                Read();
            }
            Array.Clear(found, 0, found.Length);
            if (layers == 0)
            {
                return found;
            }
            // As the terrain is drawn: its edges pass through the centres of the outermost texels.
            (int left, float shareRight) = Texel(localMetres.X, sizeMetres.X);
            (int near, float shareFar) = Texel(localMetres.Z, sizeMetres.Z);
            int right = Math.Min(left + 1, resolution - 1);
            int far = Math.Min(near + 1, resolution - 1);
            Add(left, near, (1f - shareRight) * (1f - shareFar));
            Add(right, near, shareRight * (1f - shareFar));
            Add(left, far, (1f - shareRight) * shareFar);
            Add(right, far, shareRight * shareFar);
            return found;
        }

        private void Read()
        {
            if (!isStale || terrain == null)
            {
                return;
            }
            isStale = false;
            sourceResolution = terrain.alphamapResolution;
            layers = terrain.alphamapLayers;
            texelsInOne = 1;
            resolution = sourceResolution;
            while ((long)resolution * resolution * layers > MaximumBytes && texelsInOne < RowsAtOnce)
            {
                texelsInOne *= 2;
                resolution = Math.Max(1, sourceResolution / texelsInOne);
            }
            Array.Resize(ref texels, resolution * resolution * layers);
            Array.Resize(ref found, layers);
            int rowsOfStrip = RowsAtOnce / texelsInOne;
            for (int row = 0; layers > 0 && row < resolution; row += rowsOfStrip)
            {
                ReadStrip(row, Math.Min(rowsOfStrip, resolution - row));
            }
        }

        private void ReadStrip(int firstRow, int rows)
        {
            float[,,] source = terrain.GetAlphamaps(
                0, firstRow * texelsInOne, resolution * texelsInOne, rows * texelsInOne);
            float inOne = texelsInOne * texelsInOne;
            for (int row = 0; row < rows; ++row)
            {
                for (int column = 0; column < resolution; ++column)
                {
                    for (int layer = 0; layer < layers; ++layer)
                    {
                        float sum = 0f;
                        for (int part = 0; part < texelsInOne * texelsInOne; ++part)
                        {
                            sum += source[row * texelsInOne + part / texelsInOne,
                                column * texelsInOne + part % texelsInOne, layer];
                        }
                        texels[((firstRow + row) * resolution + column) * layers + layer] =
                            (byte)(Mathf.Clamp01(sum / inOne) * byte.MaxValue + 0.5f);
                    }
                }
            }
        }

        private (int Texel, float ShareOfNext) Texel(double metres, double sizeMetres)
        {
            double source = sizeMetres > 0.0 ? metres / sizeMetres * (sourceResolution - 1) : 0.0;
            double place = (source - 0.5 * (texelsInOne - 1)) / texelsInOne;
            place = Vectors.Clamp(place, 0.0, resolution - 1);
            int texel = (int)place;
            return (texel, (float)(place - texel));
        }

        private void Add(int x, int z, float share)
        {
            int first = (z * resolution + x) * layers;
            for (int layer = 0; layer < layers; ++layer)
            {
                found[layer] += share * texels[first + layer] / byte.MaxValue;
            }
        }

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void OnSubsystemRegistration()
        {
            Forget();
            TerrainCallbacks.textureChanged -= OnPainted;
            TerrainCallbacks.textureChanged += OnPainted;
        }

        // Reading before the change has arrived from the graphics card would return the old weights.
        private static void OnPainted(Terrain painted, string textureName, RectInt texels, bool hasArrived)
        {
            if (hasArrived && painted.terrainData != null &&
                Known.TryGetValue(painted.terrainData, out TerrainWeights? weights))
            {
                weights.isStale = true;
            }
        }
    }
}
