#nullable enable
using System.Collections.Generic;
using UnityEngine;

namespace HaptoFlow.Tests
{
    internal static class TestMeshes
    {
        /// <summary>A closed box around the origin with outward front faces.</summary>
        public static Mesh Box(float size)
        {
            float half = 0.5f * size;
            return MeshOf(
                new[]
                {
                    new Vector3(-half, -half, -half), new Vector3(half, -half, -half), new Vector3(half, half, -half),
                    new Vector3(-half, half, -half), new Vector3(-half, -half, half), new Vector3(half, -half, half),
                    new Vector3(half, half, half), new Vector3(-half, half, half),
                },
                new[]
                {
                    0, 3, 2, 0, 2, 1, 4, 5, 6, 4, 6, 7, 0, 4, 7, 0, 7, 3,
                    1, 2, 6, 1, 6, 5, 3, 7, 6, 3, 6, 2, 0, 1, 5, 0, 5, 4,
                });
        }

        /// <summary>A gutter along z, open upwards: a floor of 2 cm at y = 0 and walls of 2 cm.</summary>
        public static Mesh Gutter()
        {
            var vertices = new List<Vector3>();
            var triangles = new List<int>();
            AddStrip(vertices, triangles, new Vector3(-0.01f, 0.02f, 0f), new Vector3(-0.01f, 0f, 0f));
            AddStrip(vertices, triangles, new Vector3(-0.01f, 0f, 0f), new Vector3(0.01f, 0f, 0f));
            AddStrip(vertices, triangles, new Vector3(0.01f, 0f, 0f), new Vector3(0.01f, 0.02f, 0f));
            return MeshOf(vertices.ToArray(), triangles.ToArray());
        }

        /// <summary>A step along z without anything below: a floor of 20 cm at y = 0 that ends at x = 0, and a wall down from
        /// there.</summary>
        public static Mesh Step()
        {
            var vertices = new List<Vector3>();
            var triangles = new List<int>();
            AddStrip(vertices, triangles, new Vector3(-0.2f, 0f, 0f), Vector3.zero);
            AddStrip(vertices, triangles, Vector3.zero, new Vector3(0f, -0.1f, 0f));
            return MeshOf(vertices.ToArray(), triangles.ToArray());
        }

        /// <summary>20 cm along z, between two of its edges' middles; its front is on the left of the way.</summary>
        private static void AddStrip(List<Vector3> vertices, List<int> triangles, Vector3 from, Vector3 to)
        {
            var along = new Vector3(0f, 0f, 0.1f);
            int first = vertices.Count;
            vertices.AddRange(new[] { from - along, from + along, to + along, to - along });
            triangles.AddRange(new[] { first, first + 1, first + 2, first, first + 2, first + 3 });
        }

        private static Mesh MeshOf(Vector3[] vertices, int[] triangles) =>
            new Mesh { vertices = vertices, triangles = triangles };
    }
}
