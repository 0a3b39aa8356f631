#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Numerics;
using UnityEngine;
using UnityEngine.SceneManagement;

namespace HaptoFlow
{
    /// <summary>The weights of a terrain's layers at each place: read into a byte per layer and texel, since Unity's own
    /// query makes garbage. They are read in strips of rows, one in a frame before the terrain is touched, and the strip
    /// under a tip at once. Texels of a large terrain are averaged. Main thread.</summary>
    internal sealed class TerrainWeights
    {
        private const int RowsAtOnce = 64;
        private const long MaximumBytes = 16L << 20;
        private const int FramesBetweenSearches = 30;
        private static readonly ObjectCache<TerrainCollider, TerrainWeights> Known =
            new ObjectCache<TerrainCollider, TerrainWeights>();

        private static readonly List<Terrain> Active = new List<Terrain>();
        private static readonly List<TerrainWeights> Unread = new List<TerrainWeights>();
        private static int polledFrame = -1;
        private static int framesToSearch;

        private readonly TerrainData terrain;
        private byte[]?[] strips = Array.Empty<byte[]?>();
        private float[] found = Array.Empty<float>();
        private int sourceResolution;
        private int texelsInOne = 1;
        private int rowsOfStrip = 1;
        private int resolution;
        private int layers;

        private TerrainWeights(TerrainData terrain) => this.terrain = terrain;

        public static int Count => Known.Count;

        public static long StripsRead { get; private set; }

        /// <summary>The weights for a collider; kept until the collider is destroyed.</summary>
        public static TerrainWeights Of(TerrainCollider collider, TerrainData terrain)
        {
            if (!Known.TryGetValue(collider, out TerrainWeights weights) || !ReferenceEquals(weights.terrain, terrain))
            {
                // A terrain may take megabytes.
                Known.Sweep();
                weights = new TerrainWeights(terrain);
                Known.Set(collider, weights);
            }
            return weights;
        }

        /// <summary>Reads one strip of the terrains that maps are in effect for, whenever they were loaded. Call it in
        /// every frame; further calls in a frame do nothing.</summary>
        public static void Poll()
        {
            if (!MaterialMaps.Any || Time.frameCount == polledFrame)
            {
                return;
            }
            polledFrame = Time.frameCount;
            if (Unread.Count == 0 && --framesToSearch < 0)
            {
                framesToSearch = FramesBetweenSearches;
                Search();
            }
            while (Unread.Count > 0 && !Unread[Unread.Count - 1].ReadNextStrip())
            {
                Unread.RemoveAt(Unread.Count - 1);
            }
        }

        public static void Forget()
        {
            Known.Clear();
            Unread.Clear();
            framesToSearch = 0;
        }

        /// <summary>Weights of the layers at a place. The array is reused by the next query.</summary>
        /// <param name="localMetres">Position relative to the terrain's corner.</param>
        public float[] At(Double3 localMetres, Double3 sizeMetres)
        {
            Measure();
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

        private static void Search()
        {
            Terrain.GetActiveTerrains(Active);
            foreach (Terrain each in Active)
            {
                if (each.TryGetComponent(out TerrainCollider collider) && collider.terrainData != null &&
                    MappedColliders.Resolve(collider) is { IsUniform: false })
                {
                    TerrainWeights weights = Of(collider, collider.terrainData);
                    if (!weights.IsRead())
                    {
                        Unread.Add(weights);
                    }
                }
            }
            Active.Clear();
        }

        /// <summary>Begins again where the terrain has another resolution or number of layers than before.</summary>
        private void Measure()
        {
            if (terrain == null || (terrain.alphamapResolution == sourceResolution && terrain.alphamapLayers == layers))
            {
                return;
            }
            texelsInOne = 1;
            sourceResolution = terrain.alphamapResolution;
            layers = terrain.alphamapLayers;
            resolution = sourceResolution;
            while ((long)resolution * resolution * layers > MaximumBytes && texelsInOne < RowsAtOnce)
            {
                texelsInOne *= 2;
                resolution = Math.Max(1, sourceResolution / texelsInOne);
            }
            rowsOfStrip = RowsAtOnce / texelsInOne;
            strips = new byte[]?[layers > 0 ? (resolution + rowsOfStrip - 1) / rowsOfStrip : 0];
            found = new float[layers];
        }

        private bool IsRead() => sourceResolution > 0 && Array.IndexOf(strips, null) < 0;

        private bool ReadNextStrip()
        {
            Measure();
            int next = terrain != null ? Array.IndexOf(strips, null) : -1;
            if (next < 0)
            {
                return false;
            }
            strips[next] = ReadStrip(next);
            return true;
        }

        private byte[] ReadStrip(int strip)
        {
            ++StripsRead;
            int firstRow = strip * rowsOfStrip;
            int rows = Math.Min(rowsOfStrip, resolution - firstRow);
            var texels = new byte[rows * resolution * layers];
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
                        texels[(row * resolution + column) * layers + layer] =
                            (byte)(Mathf.Clamp01(sum / inOne) * byte.MaxValue + 0.5f);
                    }
                }
            }
            return texels;
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
            int strip = z / rowsOfStrip;
            byte[]? texels = strips[strip];
            if (texels == null)
            {
                if (terrain == null)
                {
                    return;
                }
                texels = ReadStrip(strip);
                strips[strip] = texels;
            }
            int first = ((z - strip * rowsOfStrip) * resolution + x) * layers;
            for (int layer = 0; layer < layers; ++layer)
            {
                found[layer] += share * texels[first + layer] / byte.MaxValue;
            }
        }

        /// <summary>Has the strips with changed rows read again.</summary>
        private void Discard(int firstSourceRow, int sourceRows)
        {
            int rowsOfSource = rowsOfStrip * texelsInOne;
            int last = Math.Min((firstSourceRow + sourceRows - 1) / rowsOfSource, strips.Length - 1);
            for (int strip = Math.Max(0, firstSourceRow / rowsOfSource); strip <= last; ++strip)
            {
                strips[strip] = null;
            }
        }

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void OnSubsystemRegistration()
        {
            Forget();
            polledFrame = -1;
            StripsRead = 0;
            TerrainCallbacks.textureChanged -= OnPainted;
            TerrainCallbacks.textureChanged += OnPainted;
            SceneManager.sceneUnloaded -= OnSceneUnloaded;
            SceneManager.sceneUnloaded += OnSceneUnloaded;
        }

        private static void OnSceneUnloaded(Scene scene)
        {
            Known.Sweep();
            Unread.Clear();
            framesToSearch = 0;
        }

        // Reading before the change has arrived from the graphics card would return the old weights.
        private static void OnPainted(Terrain painted, string textureName, RectInt texels, bool hasArrived)
        {
            if (!hasArrived || painted.terrainData == null)
            {
                return;
            }
            foreach (TerrainWeights weights in Known.Values)
            {
                if (ReferenceEquals(weights.terrain, painted.terrainData))
                {
                    weights.Discard(texels.y, texels.height);
                }
            }
        }
    }
}
