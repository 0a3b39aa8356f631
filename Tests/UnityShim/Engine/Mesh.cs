using System;
using System.Linq;

namespace UnityEngine
{
    public enum MeshTopology
    {
        Triangles = 0,
        Quads = 2,
        Lines = 3,
        LineStrip = 4,
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
}
