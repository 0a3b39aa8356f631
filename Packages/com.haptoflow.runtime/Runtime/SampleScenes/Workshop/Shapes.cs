#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow.SampleScenes
{
    /// <summary>Creates meshes and textures at run time.</summary>
    internal static class Shapes
    {
        // The order of a box's faces. Unity draws triangles whose corners run clockwise as seen from outside.
        private static readonly Vector3[] FaceNormals =
        {
            Vector3.up, -Vector3.up, Vector3.right, -Vector3.right, Vector3.forward, -Vector3.forward,
        };

        /// <summary>Creates a sheet that faces up. Its texture coordinates run from 0 to 1 along x and z.</summary>
        /// <param name="columns">The number of vertices along x, 2 or more.</param>
        /// <param name="rows">The number of vertices along z, 2 or more.</param>
        /// <param name="corner">The position of a vertex from its texture coordinates.</param>
        public static Mesh Grid(int columns, int rows, Func<float, float, Vector3> corner)
        {
            var vertices = new Vector3[columns * rows];
            var coordinates = new Vector2[vertices.Length];
            var triangles = new int[6 * (columns - 1) * (rows - 1)];
            for (int index = 0; index < vertices.Length; ++index)
            {
                coordinates[index] = new Vector2(
                    index % columns / (columns - 1f), index / columns / (rows - 1f));
                vertices[index] = corner(coordinates[index].x, coordinates[index].y);
            }
            int next = 0;
            for (int index = 0; index < vertices.Length - columns; ++index)
            {
                if (index % columns < columns - 1)
                {
                    next = AddSquare(triangles, next, index, index + columns, index + columns + 1, index + 1);
                }
            }
            var mesh = new Mesh { vertices = vertices, uv = coordinates, triangles = triangles };
            mesh.RecalculateNormals();
            return mesh;
        }

        /// <summary>Creates boxes of one size, each as a submesh.</summary>
        public static Mesh Boxes(Vector3 size, params Vector3[] centres)
        {
            var vertices = new Vector3[24 * centres.Length];
            var mesh = new Mesh();
            var submeshes = new int[centres.Length][];
            for (int box = 0; box < centres.Length; ++box)
            {
                submeshes[box] = new int[36];
                for (int face = 0; face < FaceNormals.Length; ++face)
                {
                    int first = 24 * box + 4 * face;
                    AddFace(vertices, first, centres[box], 0.5f * size, FaceNormals[face]);
                    AddSquare(submeshes[box], 6 * face, first, first + 1, first + 2, first + 3);
                }
            }
            mesh.vertices = vertices;
            mesh.subMeshCount = centres.Length;
            for (int box = 0; box < centres.Length; ++box)
            {
                mesh.SetTriangles(submeshes[box], box);
            }
            mesh.RecalculateNormals();
            return mesh;
        }

        /// <summary>Creates a texture from pixels, row by row from the bottom.</summary>
        public static Texture2D Picture(int width, int height, Color32[] pixels)
        {
            var picture = new Texture2D(width, height, TextureFormat.RGBA32, false)
            {
                wrapMode = TextureWrapMode.Clamp,
            };
            picture.SetPixels32(pixels);
            picture.Apply(false);
            return picture;
        }

        private static void AddFace(Vector3[] vertices, int first, Vector3 centre, Vector3 half, Vector3 normal)
        {
            bool isUpright = Mathf.Abs(normal.y) < 0.5f;
            Vector3 up = isUpright ? Vector3.up : Vector3.forward;
            // In Unity's left-handed space, this points to the right as seen from outside with up upwards.
            Vector3 right = Vector3.Cross(normal, up);
            vertices[first] = centre + Vector3.Scale(half, normal - right - up);
            vertices[first + 1] = centre + Vector3.Scale(half, normal - right + up);
            vertices[first + 2] = centre + Vector3.Scale(half, normal + right + up);
            vertices[first + 3] = centre + Vector3.Scale(half, normal + right - up);
        }

        private static int AddSquare(int[] triangles, int next, int a, int b, int c, int d)
        {
            triangles[next++] = a;
            triangles[next++] = b;
            triangles[next++] = c;
            triangles[next++] = a;
            triangles[next++] = c;
            triangles[next++] = d;
            return next;
        }
    }
}
