using System;
using System.Collections.Generic;
using System.Linq;
using UnityShim;

namespace UnityEngine
{
    public enum MeshTopology
    {
        Triangles = 0,
        Lines = 3,
        Points = 5,
    }

    public sealed class Mesh : Object
    {
        private int[][] submeshes = { Array.Empty<int>() };
        private int[] all = Array.Empty<int>();

        public Vector3[] vertices { get; set; } = Array.Empty<Vector3>();

        /// <summary>The texture coordinates; empty if the mesh has none.</summary>
        public Vector2[] uv { get; set; } = Array.Empty<Vector2>();

        public Vector2[] uv2 { get; set; } = Array.Empty<Vector2>();

        /// <summary>The box around the vertices. As in Unity, it follows when triangles are assigned; here it always
        /// does.</summary>
        public Bounds bounds
        {
            get
            {
                var found = new Bounds(vertices.Length > 0 ? vertices[0] : Vector3.zero, Vector3.zero);
                foreach (Vector3 vertex in vertices)
                {
                    found.Encapsulate(vertex);
                }
                return found;
            }
        }

        public bool isReadable { get; private set; } = true;

        /// <summary>The triangles of all submeshes.</summary>
        public int[] triangles
        {
            get => all;
            set
            {
                submeshes = new[] { value };
                all = value;
            }
        }

        public int subMeshCount
        {
            get => submeshes.Length;
            set
            {
                int before = submeshes.Length;
                Array.Resize(ref submeshes, value);
                for (int index = before; index < value; ++index)
                {
                    submeshes[index] = Array.Empty<int>();
                }
                all = submeshes.SelectMany(each => each).ToArray();
            }
        }

        public void SetTriangles(int[] triangles, int submesh)
        {
            submeshes[submesh] = triangles;
            all = submeshes.SelectMany(each => each).ToArray();
        }

        public uint GetIndexCount(int submesh) => (uint)submeshes[submesh].Length;

        public MeshTopology GetTopology(int submesh) => MeshTopology.Triangles;

        public void RecalculateNormals()
        {
        }

        /// <summary>Makes the mesh unreadable for scripts. The shim keeps the data for its own use.</summary>
        public void UploadMeshData(bool markNoLongerReadable) => isReadable &= !markNoLongerReadable;
    }

    public sealed class TerrainLayer : Object
    {
        public Texture2D? normalMapTexture { get; set; }
        public Vector2 tileSize { get; set; } = new Vector2(15f, 15f);
        public Vector2 tileOffset { get; set; }
        public float normalScale { get; set; } = 1f;
    }

    public sealed class TerrainData : Object
    {
        private float[,] heights = new float[33, 33];
        private float[,,] weights = new float[16, 16, 0];
        private TerrainLayer[] layers = Array.Empty<TerrainLayer>();

        public Vector3 size { get; set; } = new Vector3(1f, 1f, 1f);

        public int heightmapResolution
        {
            get => heights.GetLength(0);
            set => heights = new float[value, value];
        }

        public int alphamapResolution
        {
            get => weights.GetLength(0);
            set => weights = FirstLayerOnly(value, layers.Length);
        }

        public int alphamapLayers => layers.Length;

        /// <summary>Reading allocates, as in Unity.</summary>
        public TerrainLayer[] terrainLayers
        {
            get => layers.ToArray();
            set
            {
                layers = value.ToArray();
                weights = FirstLayerOnly(alphamapResolution, layers.Length);
            }
        }

        public void SetHeights(int xBase, int yBase, float[,] heights)
        {
            for (int y = 0; y < heights.GetLength(0); ++y)
            {
                for (int x = 0; x < heights.GetLength(1); ++x)
                {
                    this.heights[yBase + y, xBase + x] = heights[y, x];
                }
            }
        }

        /// <summary>The indices are row z, column x, layer.</summary>
        public float[,,] GetAlphamaps(int x, int y, int width, int height)
        {
            var part = new float[height, width, layers.Length];
            for (int index = 0; index < part.Length; ++index)
            {
                (int row, int column, int layer) = Place(index, width);
                part[row, column, layer] = weights[y + row, x + column, layer];
            }
            return part;
        }

        public void SetAlphamaps(int x, int y, float[,,] map)
        {
            for (int index = 0; index < map.Length; ++index)
            {
                (int row, int column, int layer) = Place(index, map.GetLength(1));
                weights[y + row, x + column, layer] = map[row, column, layer];
            }
            foreach (Terrain user in World.Find<Terrain>(true).Where(each => ReferenceEquals(each.terrainData, this)))
            {
                TerrainCallbacks.Invoke(user, new RectInt(x, y, map.GetLength(1), map.GetLength(0)));
            }
        }

        /// <summary>The indices are row z, column x, as for <see cref="SetHeights"/>.</summary>
        internal Vector3 VertexAt(int x, int z)
        {
            float last = heightmapResolution - 1;
            return Vector3.Scale(size, new Vector3(x / last, heights[z, x], z / last));
        }

        private (int Row, int Column, int Layer) Place(int index, int width) =>
            (index / layers.Length / width, index / layers.Length % width, index % layers.Length);

        private static float[,,] FirstLayerOnly(int resolution, int layers)
        {
            var made = new float[resolution, resolution, layers];
            for (int place = 0; layers > 0 && place < resolution * resolution; ++place)
            {
                made[place / resolution, place % resolution, 0] = 1f;
            }
            return made;
        }
    }

    public sealed class Terrain : Behaviour
    {
        public TerrainData? terrainData { get; set; }

        public bool drawHeightmap { get; set; } = true;

        public static void GetActiveTerrains(List<Terrain> terrainList)
        {
            terrainList.Clear();
            for (int index = 0; index < World.AllObjects.Count; ++index)
            {
                if (World.AllObjects[index].TryGetComponent(out Terrain terrain) && terrain.isActiveAndEnabled)
                {
                    terrainList.Add(terrain);
                }
            }
        }

        public static GameObject CreateTerrainGameObject(TerrainData assignTerrain)
        {
            var made = new GameObject("Terrain");
            made.AddComponent<Terrain>().terrainData = assignTerrain;
            made.AddComponent<TerrainCollider>().terrainData = assignTerrain;
            return made;
        }
    }

    public static class TerrainCallbacks
    {
        public delegate void TextureChangedCallback(
            Terrain terrain, string textureName, RectInt texelRegion, bool synched);

        public static event TextureChangedCallback? textureChanged;

        internal static void Invoke(Terrain terrain, RectInt region) =>
            textureChanged?.Invoke(terrain, "alphamap", region, true);
    }

    public struct RectInt
    {
        public RectInt(int xMin, int yMin, int width, int height)
        {
            (x, y, this.width, this.height) = (xMin, yMin, width, height);
        }

        public int x { get; set; }
        public int y { get; set; }
        public int width { get; set; }
        public int height { get; set; }
    }
}
