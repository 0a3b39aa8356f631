#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>The Inspector of a mask: its texture, its channels, and a button to bake it.</summary>
    [CustomEditor(typeof(HapticMaskMap))]
    internal sealed class HapticMaskMapEditor : UnityEditor.Editor
    {
        private static readonly string[] Fields =
        {
            "texture", "largestSize", "secondCoordinates", "tiling", "offset", "red", "green", "blue", "alpha",
        };

        public override void OnInspectorGUI()
        {
            var mask = (HapticMaskMap)target;
            // Read before any field is drawn, so that layout and drawing show the same controls.
            string? problem = MaskBake.ProblemOf(mask);
            Repair[] repairs = MaskBake.RepairsOf(mask).ToArray();
            serializedObject.Update();
            foreach (string field in Fields)
            {
                EditorGUILayout.PropertyField(serializedObject.FindProperty(field));
            }
            serializedObject.ApplyModifiedProperties();
            if (problem != null)
            {
                EditorGUILayout.HelpBox(problem, MessageType.Warning);
            }
            else if (mask.IsBaked)
            {
                EditorGUILayout.HelpBox($"Baked: {mask.Width} x {mask.Height} texels.", MessageType.None);
            }
            Action? chosen = null;
            foreach (Repair repair in repairs)
            {
                if (GUILayout.Button(repair.Caption))
                {
                    chosen = repair.Act;
                }
            }
            chosen?.Invoke();
        }
    }

    /// <summary>Draws a channel of a mask: a material, or a factor between two values.</summary>
    [CustomPropertyDrawer(typeof(MaskChannel))]
    internal sealed class MaskChannelDrawer : PropertyDrawer
    {
        private static readonly GUIContent Lowest = new GUIContent("At Black");
        private static readonly GUIContent Highest = new GUIContent("At White");

        public override float GetPropertyHeight(SerializedProperty property, GUIContent label)
        {
            MaskChannelUse use = UseOf(property);
            int rows = use == MaskChannelUse.Nothing ? 1 : use == MaskChannelUse.Material ? 2 : 3;
            return InspectorRows.Height(rows);
        }

        public override void OnGUI(Rect position, SerializedProperty property, GUIContent label)
        {
            MaskChannelUse use = UseOf(property);
            var rows = new InspectorRows(position, property);
            rows.Field("use", label);
            if (use == MaskChannelUse.Nothing)
            {
                return;
            }
            using var indent = new EditorGUI.IndentLevelScope();
            if (use == MaskChannelUse.Material)
            {
                rows.Field("material");
                return;
            }
            rows.Field("lowest", Lowest);
            rows.Field("highest", Highest);
        }

        private static MaskChannelUse UseOf(SerializedProperty property) =>
            (MaskChannelUse)property.FindPropertyRelative("use").enumValueIndex;
    }

    /// <summary>Bakes the texture of a mask map into its compact copy.</summary>
    internal static class MaskBake
    {
        public static string? ProblemOf(HapticMaskMap mask)
        {
            Texture2D? texture = mask.Texture;
            if (texture == null)
            {
                return mask.IsBaked ? null : $"{mask.name} has no texture to bake: it has no effect.";
            }
            if (!texture.isReadable)
            {
                string consequence = mask.IsBaked
                    ? "its changes cannot be baked"
                    : "it cannot be baked and has no effect";
                return $"{mask.name}: the texture {texture.name} is not readable, so {consequence}. Switch on " +
                    "Read/Write in its import settings.";
            }
            if (!mask.IsBaked)
            {
                return $"{mask.name} is not baked: it has no effect.";
            }
            return mask.BakedContents != ContentsOf(mask, texture)
                ? $"{mask.name}: the texture {texture.name} or the largest size has changed since the mask was baked."
                : null;
        }

        /// <summary>A button that makes the texture readable, else a button that bakes.</summary>
        public static IEnumerable<Repair> RepairsOf(HapticMaskMap mask)
        {
            if (mask.Texture == null)
            {
                yield break;
            }
            if (mask.Texture.isReadable)
            {
                yield return new Repair("Bake", () => Bake(mask, mask.Texture!));
                yield break;
            }
            foreach (Repair repair in Readability.RepairsOf(new[] { mask.Texture }))
            {
                yield return repair;
            }
        }

        /// <summary>Bakes a readable texture into the mask, as one step of undo.</summary>
        private static void Bake(HapticMaskMap mask, Texture2D texture)
        {
            int halvings = 0;
            while (Math.Max(texture.width, texture.height) >> halvings > mask.MaximumSize)
            {
                ++halvings;
            }
            int width = Math.Max(1, texture.width >> halvings);
            int height = Math.Max(1, texture.height >> halvings);
            Color32[] pixels = Shrink(texture.GetPixels32(), texture.width, texture.height, width, height);
            Undo.RecordObject(mask, "Bake the Mask");
            mask.SetPixels(width, height, pixels, texture.wrapMode == TextureWrapMode.Repeat);
            mask.BakedContents = ContentsOf(mask, texture);
            EditorUtility.SetDirty(mask);
        }

        private static string ContentsOf(HapticMaskMap mask, Texture2D texture) =>
            $"{texture.imageContentsHash} at {mask.MaximumSize}, {texture.wrapMode}";

        /// <summary>Scales pixels down: each new pixel is the mean of those that it covers.</summary>
        private static Color32[] Shrink(Color32[] pixels, int width, int height, int newWidth, int newHeight)
        {
            if (width == newWidth && height == newHeight)
            {
                return pixels;
            }
            var smaller = new Color32[newWidth * newHeight];
            for (int y = 0; y < newHeight; ++y)
            {
                for (int x = 0; x < newWidth; ++x)
                {
                    smaller[y * newWidth + x] = Mean(pixels, width, x * width / newWidth, (x + 1) * width / newWidth,
                        y * height / newHeight, (y + 1) * height / newHeight);
                }
            }
            return smaller;
        }

        private static Color32 Mean(Color32[] pixels, int width, int left, int right, int low, int high)
        {
            long red = 0;
            long green = 0;
            long blue = 0;
            long alpha = 0;
            for (int y = low; y < high; ++y)
            {
                for (int x = left; x < right; ++x)
                {
                    Color32 pixel = pixels[y * width + x];
                    red += pixel.r;
                    green += pixel.g;
                    blue += pixel.b;
                    alpha += pixel.a;
                }
            }
            long count = (long)(right - left) * (high - low);
            return new Color32(Rounded(red, count), Rounded(green, count), Rounded(blue, count), Rounded(alpha, count));
        }

        private static byte Rounded(long sum, long count) => (byte)((sum + count / 2) / count);
    }

    /// <summary>Makes imported meshes and textures readable through their import settings.</summary>
    internal static class Readability
    {
        private const string Caption = "Enable Read/Write";

        /// <summary>A button for the imported ones among the assets; none if all were created by scripts. An import
        /// cannot be undone.</summary>
        public static IEnumerable<Repair> RepairsOf(IEnumerable<Object> assets)
        {
            string[] paths = assets.Select(AssetDatabase.GetAssetPath)
                .Where(path => path.Length > 0 && CanEnable(AssetImporter.GetAtPath(path))).Distinct().ToArray();
            return paths.Length == 0
                ? Enumerable.Empty<Repair>()
                : new[] { new Repair(Caption, () => Enable(paths)) };
        }

        private static bool CanEnable(AssetImporter? importer) =>
            importer is TextureImporter || importer is ModelImporter;

        private static void Enable(IEnumerable<string> paths)
        {
            foreach (string path in paths)
            {
                AssetImporter importer = AssetImporter.GetAtPath(path)!;
                if (importer is TextureImporter texture)
                {
                    texture.isReadable = true;
                }
                if (importer is ModelImporter model)
                {
                    model.isReadable = true;
                }
                importer.SaveAndReimport();
            }
        }
    }
}
