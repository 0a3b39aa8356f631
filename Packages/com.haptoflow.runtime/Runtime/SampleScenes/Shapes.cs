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

        public static MeshRenderer Show(string name, Vector3 place, Mesh mesh)
        {
            var owner = new GameObject(name);
            owner.transform.position = place;
            owner.AddComponent<MeshFilter>().sharedMesh = mesh;
            var renderer = owner.AddComponent<MeshRenderer>();
            PipelineMaterial.Paint(renderer, Color.white);
            return renderer;
        }

        /// <summary>Makes a mesh that is shown one that a pen touches.</summary>
        public static MeshCollider Touchable(MeshRenderer shown)
        {
            var collider = shown.gameObject.AddComponent<MeshCollider>();
            collider.sharedMesh = shown.GetComponent<MeshFilter>().sharedMesh;
            return collider;
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

    /// <summary>A mesh of two submeshes, each drawn with its own material. The rules match these materials.</summary>
    internal static class TwoHalves
    {
        private static readonly Vector3 Half = new Vector3(0.19f, 0.012f, 0.22f);

        /// <summary>The size of both halves together, in metres.</summary>
        public static readonly Vector3 Size = new Vector3(2f * Half.x, Half.y, Half.z);

        private static readonly (string Paint, string Label, Color Colour)[] Sides =
        {
            ("Oak", "wood", new Color(0.64f, 0.45f, 0.25f)), ("Steel", "metal mesh", new Color(0.55f, 0.6f, 0.68f)),
        };

        /// <param name="place">The position of the middle of its underside.</param>
        public static MeshCollider Build(WorkshopScene scene, Vector3 place)
        {
            var left = new Vector3(-0.5f * Half.x, 0.5f * Half.y, 0f);
            MeshRenderer renderer = Shapes.Show("Two Halves", place, scene.Keep(Shapes.Boxes(
                Half, left, new Vector3(-left.x, left.y, left.z))));
            var paints = new Material[Sides.Length];
            for (int side = 0; side < Sides.Length; ++side)
            {
                paints[side] = scene.Keep(new Material(renderer.sharedMaterial!));
                paints[side].name = Sides[side].Paint;
                paints[side].color = Sides[side].Colour;
                scene.Map.Add(HapticMaterialRule.ForRendererMaterial(
                    paints[side], scene.CreateMaterial(Sides[side].Label)));
            }
            renderer.sharedMaterials = paints;
            return Shapes.Touchable(renderer);
        }
    }

    /// <summary>A pane of ceramic with a mask. The red channel selects jute in a ring, the green channel scales the
    /// strength.</summary>
    internal static class InlaidPane
    {
        private const int Texels = 128;

        /// <summary>The size of the whole, in metres.</summary>
        public static readonly Vector3 Size = new Vector3(0.26f, 0.008f, 0.18f);

        private static readonly Color32 Ceramic = new Color32(225, 228, 222, 255);
        private static readonly Color32 Jute = new Color32(181, 154, 76, 255);

        /// <param name="place">The position of the middle of its underside.</param>
        public static MeshCollider Build(WorkshopScene scene, Vector3 place)
        {
            HapticMaskMap mask = scene.Keep(ScriptableObject.CreateInstance<HapticMaskMap>());
            mask.name = "Ring";
            mask.Red.SetMaterial(scene.CreateMaterial("jute"));
            mask.Green.SetFactor(MaskChannelUse.Strength, 0.3f, 1f);
            mask.SetPixels(Texels, Texels, Pixels((ring, wear) =>
                new Color32(Level(ring), Level(1f - wear), 0, 0)), false);
            HapticMaterialRule rule = HapticMaterialRule.ForName("Inlaid Pane", scene.CreateMaterial("ceramic"));
            rule.Mask = mask;
            scene.Map.Add(rule);

            MeshRenderer renderer = Shapes.Show("Inlaid Pane", place, scene.Keep(Shapes.Grid(2, 2, (x, z) =>
                new Vector3((x - 0.5f) * Size.x, Size.y, (z - 0.5f) * Size.z))));
            renderer.material.mainTexture = scene.Keep(Shapes.Picture(Texels, Texels, Pixels((ring, wear) =>
                Color32.Lerp(Ceramic, Jute, ring * (1f - 0.5f * wear)))));
            return Shapes.Touchable(renderer);
        }

        /// <param name="colour">The colour of a pixel from the ring's share there and the wear, each 0 to 1.</param>
        private static Color32[] Pixels(Func<float, float, Color32> colour)
        {
            var pixels = new Color32[Texels * Texels];
            for (int index = 0; index < pixels.Length; ++index)
            {
                float x = (index % Texels + 0.5f) / Texels;
                float z = (index / Texels + 0.5f) / Texels;
                float right = (x - 0.5f) * Size.x;
                float far = (z - 0.5f) * Size.z;
                float fromRing = Mathf.Abs(Mathf.Sqrt(right * right + far * far) - 0.055f);
                pixels[index] = colour(Mathf.Clamp01(5f - 250f * fromRing), x);
            }
            return pixels;
        }

        private static byte Level(float share) => (byte)(255f * share + 0.5f);
    }

    /// <summary>A terrain of three layers that blend into each other. A separate mesh draws it, because the look of a
    /// terrain created by a script depends on the render pipeline.</summary>
    internal static class GardenBed
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

        /// <param name="corner">The position of the terrain's origin, its corner.</param>
        public static Terrain Build(WorkshopScene scene, Vector3 corner)
        {
            TerrainData data = scene.Keep(new TerrainData());
            data.heightmapResolution = Corners;
            data.size = Size;
            data.alphamapResolution = Texels;
            var layers = new TerrainLayer[Layers.Length];
            for (int layer = 0; layer < layers.Length; ++layer)
            {
                layers[layer] = scene.Keep(new TerrainLayer { name = Layers[layer].Layer });
                scene.Map.Add(HapticMaterialRule.ForTerrainLayer(
                    layers[layer], scene.CreateMaterial(Layers[layer].Label)));
            }
            data.terrainLayers = layers;
            data.SetHeights(0, 0, Heights());
            data.SetAlphamaps(0, 0, Weights());
            GameObject owner = Terrain.CreateTerrainGameObject(data);
            owner.name = "Garden";
            owner.transform.position = corner;
            var terrain = owner.GetComponent<Terrain>();
            terrain.drawHeightmap = false;
            Draw(scene, owner.transform);
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

        private static void Draw(WorkshopScene scene, Transform terrain)
        {
            MeshRenderer renderer = Shapes.Show("Garden Look", terrain.position, scene.Keep(
                Shapes.Grid(Corners, Corners, (x, z) => Vector3.Scale(Size, new Vector3(x, Height(x, z), z)))));
            renderer.transform.SetParent(terrain, true);
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
            renderer.material.mainTexture = scene.Keep(Shapes.Picture(Texels, 1, pixels));
        }
    }
}
