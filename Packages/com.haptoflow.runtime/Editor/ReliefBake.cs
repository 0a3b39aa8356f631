#nullable enable
using System;
using System.Linq;
using HaptoFlow.Numerics;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>Bakes the height or normal map of an object's material into a relief. Main thread.</summary>
    internal static class ReliefBake
    {
        private const float DefaultDepthMillimetres = 1f;

        // Smaller differences are rounding of a map of 8 bits.
        private const float SmallestRange = 0.5f / 255f;

        /// <summary>Bakes into the surface's relief, or into a new asset beside the material, as one step of
        /// undo.</summary>
        /// <returns>What the user has to know, as a sentence: why nothing was baked, or what is not known; null when
        /// all is well.</returns>
        public static string? Take(HapticSurface surface)
        {
            if (!ReliefSource.TryFind(surface, out ReliefSource source))
            {
                return $"{surface.name}: its renderer has no material with a height or normal map. Give the material " +
                    "one, or set the heights of a Haptic Relief by a script.";
            }
            Vector2? size = source.MetresOf();
            Vector2 before = surface.Relief != null ? surface.Relief.SizeMetres : new Vector2(0.1f, 0.1f);
            BakedHeights heights;
            try
            {
                heights = Bake(source, size ?? before);
            }
            catch (HaptoFlowException refusal)
            {
                return $"The map {source.Texture.name} of {source.Material.name} was not baked: {refusal.Message}.";
            }
            if (heights.AreEven)
            {
                return $"The map {source.Texture.name} of {source.Material.name} is even: it has no heights.";
            }
            heights.SizeMetres = size ?? before;
            (heights.Tiling, heights.Offset, heights.Repeats) = (source.Tiling, source.Offset, source.Repeats);
            HapticRelief relief = Write(surface, source.Material, heights);
            return size.HasValue
                ? null
                : $"{relief.name} does not know how large its map is, because the mesh of {source.Renderer.name} is " +
                    "not readable or has no texture coordinates. Set its size, or switch on Read/Write in the " +
                    "model's import settings and bake again.";
        }

        /// <summary>Writes into the surface's relief, or into a new asset beside what the heights are from, as one step
        /// of undo.</summary>
        public static HapticRelief Write(HapticSurface surface, Object from, in BakedHeights heights)
        {
            Undo.IncrementCurrentGroup();
            Undo.SetCurrentGroupName($"Take the Relief of {surface.name}");
            int group = Undo.GetCurrentGroup();
            HapticRelief relief = surface.Relief != null ? surface.Relief : Create(surface, from);
            Write(relief, heights);
            Undo.CollapseUndoOperations(group);
            return relief;
        }

        /// <summary>Can be undone.</summary>
        public static void Write(HapticRelief relief, in BakedHeights heights)
        {
            Undo.RecordObject(relief, "Bake the Relief");
            (relief.Tiling, relief.Offset) = (heights.Tiling, heights.Offset);
            relief.Repeats = heights.Repeats ?? relief.Repeats;
            relief.DepthMillimetres = heights.DepthMillimetres;
            relief.SizeMetres = heights.SizeMetres;
            relief.SetHeights(heights.Columns, heights.Rows, heights.Shares);
            EditorUtility.SetDirty(relief);
        }

        private static HapticRelief Create(HapticSurface surface, Object from)
        {
            var relief = ScriptableObject.CreateInstance<HapticRelief>();
            // An object that is no asset has an empty path, which Path.GetDirectoryName refuses under Mono.
            string path = AssetDatabase.GetAssetPath(from);
            string folder = path.StartsWith("Assets/", StringComparison.Ordinal)
                ? path.Substring(0, path.LastIndexOf('/'))
                : "Assets";
            AssetDatabase.CreateAsset(
                relief, AssetDatabase.GenerateUniqueAssetPath($"{folder}/{from.name} Relief.asset"));
            Undo.RegisterCreatedObjectUndo(relief, "Create the Relief");
            SerializedFields.Set(surface, "relief", property => property.objectReferenceValue = relief);
            return relief;
        }

        private static BakedHeights Bake(ReliefSource source, Vector2 sizeMetres)
        {
            if (source.IsNormals)
            {
                return BakeNormals(source.Texture, source.NormalScale, sizeMetres, source.Repeats);
            }
            (Color[] pixels, int columns, int rows) = TexelsOf(source.Texture);
            float[] values = HeightsOf(pixels, source.IsRed);
            float? depth = 1000f * source.DepthMetresOf(sizeMetres);
            return new BakedHeights(columns, rows, values, depth > 0f ? depth.Value : DefaultDepthMillimetres,
                values.Max() - values.Min() < SmallestRange);
        }

        /// <summary>The heights of a normal map.</summary>
        /// <exception cref="HaptoFlowException">As of <see cref="HapticReliefMap.HeightsOfNormals"/>.</exception>
        public static BakedHeights BakeNormals(Texture2D texture, float scale, Vector2 sizeMetres, bool repeats)
        {
            (Color[] pixels, int columns, int rows) = TexelsOf(texture);
            return BakedHeights.OfMetres(columns, rows, HapticReliefMap.HeightsOfNormals(
                NormalsOf(pixels, scale), columns, (sizeMetres.x, sizeMetres.y), repeats));
        }

        /// <summary>The pixels, averaged until a relief can have so many.</summary>
        private static (Color[] Pixels, int Columns, int Rows) TexelsOf(Texture2D texture)
        {
            (Color[] pixels, int columns, int rows) = (PixelsOf(texture), texture.width, texture.height);
            while ((long)columns * rows > HapticReliefMap.MaximumTexels)
            {
                pixels = Halved(pixels, columns, rows);
                (columns, rows) = (columns / 2, rows / 2);
            }
            return (pixels, columns, rows);
        }

        /// <summary>The pixels as a shader reads them, from the bottom, whether or not scripts may read the
        /// texture.</summary>
        private static Color[] PixelsOf(Texture2D texture)
        {
            RenderTexture? before = RenderTexture.active;
            RenderTexture target = RenderTexture.GetTemporary(
                texture.width, texture.height, 0, RenderTextureFormat.ARGBFloat, RenderTextureReadWrite.Linear);
            var copy = new Texture2D(texture.width, texture.height, TextureFormat.RGBAFloat, false, true);
            try
            {
                Graphics.Blit(texture, target);
                RenderTexture.active = target;
                copy.ReadPixels(new Rect(0f, 0f, texture.width, texture.height), 0, 0, false);
                return copy.GetPixels();
            }
            finally
            {
                RenderTexture.active = before;
                RenderTexture.ReleaseTemporary(target);
                Object.DestroyImmediate(copy);
            }
        }

        private static Color[] Halved(Color[] pixels, int columns, int rows)
        {
            var halved = new Color[columns / 2 * (rows / 2)];
            for (int index = 0; index < halved.Length; ++index)
            {
                int corner = index / (columns / 2) * 2 * columns + index % (columns / 2) * 2;
                halved[index] = 0.25f * (pixels[corner] + pixels[corner + 1] + pixels[corner + columns] +
                    pixels[corner + columns + 1]);
            }
            return halved;
        }

        /// <summary>The channel that the shader reads, else red, which maps of one channel have alone.</summary>
        private static float[] HeightsOf(Color[] pixels, bool isRed)
        {
            float[] green = Array.ConvertAll(pixels, pixel => pixel.g);
            return isRed || green.Max() - green.Min() < SmallestRange
                ? Array.ConvertAll(pixels, pixel => pixel.r)
                : green;
        }

        /// <summary>Unpacks normals as Unity's shaders do: x in red or, compressed, in alpha; y in green.</summary>
        private static float[] NormalsOf(Color[] pixels, float scale)
        {
            var normals = new float[3 * pixels.Length];
            for (int index = 0; index < pixels.Length; ++index)
            {
                float x = 2f * pixels[index].r * pixels[index].a - 1f;
                float y = 2f * pixels[index].g - 1f;
                normals[3 * index] = scale * x;
                normals[3 * index + 1] = scale * y;
                normals[3 * index + 2] = Mathf.Sqrt(Mathf.Max(0f, 1f - x * x - y * y));
            }
            return normals;
        }
    }

    /// <summary>What a relief gets from where it is taken from.</summary>
    internal struct BakedHeights
    {
        public readonly int Columns;
        public readonly int Rows;
        public readonly float[] Shares;
        public readonly float DepthMillimetres;
        public readonly bool AreEven;
        public Vector2 SizeMetres;
        public Vector2 Tiling;
        public Vector2 Offset;

        /// <summary>Null to leave it as it is.</summary>
        public bool? Repeats;

        public BakedHeights(int columns, int rows, float[] shares, float depthMillimetres, bool areEven)
        {
            (Columns, Rows, Shares, DepthMillimetres, AreEven) = (columns, rows, shares, depthMillimetres, areEven);
            (SizeMetres, Tiling, Offset, Repeats) = (default, new Vector2(1f, 1f), default, null);
        }

        /// <param name="metres">The lowest is 0.</param>
        public static BakedHeights OfMetres(int columns, int rows, float[] metres)
        {
            float highest = metres.Max();
            return new BakedHeights(columns, rows, Array.ConvertAll(metres, height => height / highest),
                1000f * highest, 1000f * highest < HapticRelief.MinimumDepthMillimetres);
        }
    }

    /// <summary>The height or normal map of a material, by the names of Unity's Standard, URP Lit and HDRP Lit
    /// shaders.</summary>
    internal readonly struct ReliefSource
    {
        private static readonly string[] HeightMaps = { "_ParallaxMap", "_HeightMap" };
        private static readonly string[] NormalMaps = { "_BumpMap", "_NormalMap" };
        private static readonly string[] NormalScales = { "_BumpScale", "_NormalScale" };

        // All maps of a material have the scale and the offset of this one.
        private static readonly string[] ColourMaps = { "_BaseColorMap", "_BaseMap", "_MainTex" };

        private ReliefSource(Renderer renderer, Material material, string map)
        {
            Renderer = renderer;
            Material = material;
            Texture = (Texture2D)material.GetTexture(map)!;
            IsNormals = Array.IndexOf(NormalMaps, map) >= 0;
            IsRed = map == "_HeightMap";
            string? colour = Array.Find(ColourMaps, material.HasProperty);
            Tiling = colour == null ? new Vector2(1f, 1f) : material.GetTextureScale(colour);
            Offset = colour == null ? Vector2.zero : material.GetTextureOffset(colour);
        }

        public Renderer Renderer { get; }

        public Material Material { get; }

        public Texture2D Texture { get; }

        public bool IsNormals { get; }

        /// <summary>True where the shader reads heights from red; green otherwise.</summary>
        public bool IsRed { get; }

        public Vector2 Tiling { get; }

        public Vector2 Offset { get; }

        public bool Repeats => Texture.wrapMode == TextureWrapMode.Repeat;

        public float NormalScale
        {
            get
            {
                string? scale = Array.Find(NormalScales, Material.HasProperty);
                return scale == null ? 1f : Material.GetFloat(scale);
            }
        }

        /// <summary>The first height map of the surface's renderers, else their first normal map.</summary>
        public static bool TryFind(HapticSurface surface, out ReliefSource found)
        {
            found = SceneColliders.Below(new[] { surface.gameObject })
                .Where(collider => SceneColliders.SurfaceOf(collider) == surface)
                .Select(ColliderFacts.RendererOf).Where(renderer => renderer != null).Distinct()
                .SelectMany(renderer => renderer!.sharedMaterials.Where(material => material != null)
                    .SelectMany(material => HeightMaps.Concat(NormalMaps)
                        .Where(map => material.HasProperty(map) && material.GetTexture(map) is Texture2D texture &&
                            texture != null)
                        .Select(map => new ReliefSource(renderer, material, map))))
                .OrderBy(source => source.IsNormals).FirstOrDefault();
            return found.Texture is object;
        }

        /// <summary>The depth that the material's parallax has; null where the shader has none.</summary>
        public float? DepthMetresOf(Vector2 sizeMetres) => IsRed
            ? Material.HasProperty("_HeightAmplitude") ? Material.GetFloat("_HeightAmplitude") : (float?)null
            : Material.HasProperty("_Parallax") ? Material.GetFloat("_Parallax") * sizeMetres.x : (float?)null;

        /// <summary>The mean length of the map over the renderer's mesh, along its columns and rows, in metres of the
        /// world; null where the mesh cannot be read.</summary>
        public Vector2? MetresOf()
        {
            bool hasMesh = Renderer.TryGetComponent(out MeshFilter filter) && filter.sharedMesh != null &&
                filter.sharedMesh.isReadable;
            if (!hasMesh)
            {
                return null;
            }
            var coordinates = new MeshCoordinates(filter.sharedMesh!);
            Double3 scale = Renderer.transform.lossyScale.ToDouble();
            (double columns, double rows, double area) = (0.0, 0.0, 0.0);
            for (int triangle = 0; triangle < coordinates.Triangles; ++triangle)
            {
                if (coordinates.TryMeasure(
                    triangle, scale, out Double3 ofColumns, out Double3 ofRows, out double squareMetres))
                {
                    columns += squareMetres * ofColumns.Length;
                    rows += squareMetres * ofRows.Length;
                    area += squareMetres;
                }
            }
            columns *= Math.Abs(Tiling.x);
            rows *= Math.Abs(Tiling.y);
            return columns > 0.0 && rows > 0.0
                ? new Vector2((float)(area / columns), (float)(area / rows))
                : (Vector2?)null;
        }
    }

    /// <summary>The buttons that bake a surface's relief, and what the last press of one has to say.</summary>
    internal sealed class ReliefButton
    {
        public const string Caption = "Take from the Object's Material";

        private string? remark;

        public void Draw(HapticSurface surface)
        {
            // Read before the button is drawn, so that layout and drawing show the same controls.
            string? shown = remark;
            TerrainCollider? terrain = TerrainRelief.TerrainOf(surface);
            if (terrain == null && GUILayout.Button(Caption))
            {
                remark = ReliefBake.Take(surface);
            }
            if (terrain != null && GUILayout.Button(TerrainRelief.Caption))
            {
                remark = TerrainRelief.Take(surface, terrain);
            }
            if (shown != null)
            {
                EditorGUILayout.HelpBox(shown, MessageType.Warning);
            }
        }
    }
}
