#nullable enable
using System;
using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Bakes the texture of a mask map into its compact copy.</summary>
    internal static class MaskBake
    {
        /// <summary>The problem of a mask; null without one.</summary>
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
                yield return new Repair("Bake", () => Bake(mask));
                yield break;
            }
            foreach (Repair repair in Readability.RepairsOf(new[] { mask.Texture }))
            {
                yield return repair;
            }
        }

        /// <summary>Bakes the mask, as one step of undo.</summary>
        /// <exception cref="InvalidOperationException">There is no texture, or it is not readable. The mask does not
        /// change.</exception>
        public static void Bake(HapticMaskMap mask)
        {
            Texture2D? texture = mask.Texture;
            if (texture == null)
            {
                throw new InvalidOperationException($"{mask.name} has no texture to bake");
            }
            if (!texture.isReadable)
            {
                throw new InvalidOperationException($"the texture {texture.name} is not readable: switch on " +
                    "Read/Write in its import settings");
            }
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
}
