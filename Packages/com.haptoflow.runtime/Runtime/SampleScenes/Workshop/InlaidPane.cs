#nullable enable
using System;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.SampleScenes
{
    /// <summary>A pane of ceramic with a mask. The red channel selects jute in a ring, the green channel scales the
    /// strength.</summary>
    internal sealed class InlaidPane
    {
        private const int Texels = 128;

        /// <summary>The size of the whole, in metres.</summary>
        public static readonly Vector3 Size = new Vector3(0.26f, 0.008f, 0.18f);

        private static readonly Color32 Ceramic = new Color32(225, 228, 222, 255);
        private static readonly Color32 Jute = new Color32(181, 154, 76, 255);

        private readonly Vector3 place;
        private readonly Func<Object, Object> keep;

        /// <param name="place">The position of the middle of its underside.</param>
        /// <param name="keep">Marks an asset to be destroyed with the scene.</param>
        public InlaidPane(Vector3 place, Func<Object, Object> keep) => (this.place, this.keep) = (place, keep);

        public MeshCollider Build(HapticMaterialMap map, Func<string, HapticMaterial> createMaterial)
        {
            var mask = (HapticMaskMap)keep(ScriptableObject.CreateInstance<HapticMaskMap>());
            mask.name = "Ring";
            mask.Red.SetMaterial(createMaterial("jute"));
            mask.Green.SetFactor(MaskChannelUse.Strength, 0.3f, 1f);
            mask.SetPixels(Texels, Texels, Pixels((ring, wear) =>
                new Color32(Level(ring), Level(1f - wear), 0, 0)), false);
            HapticMaterialRule rule = HapticMaterialRule.ForName("Inlaid Pane", createMaterial("ceramic"));
            rule.Mask = mask;
            map.Add(rule);

            var owner = new GameObject("Inlaid Pane");
            owner.transform.position = place;
            var mesh = (Mesh)keep(Shapes.Grid(2, 2, (x, z) =>
                new Vector3((x - 0.5f) * Size.x, Size.y, (z - 0.5f) * Size.z)));
            owner.AddComponent<MeshFilter>().sharedMesh = mesh;
            var renderer = owner.AddComponent<MeshRenderer>();
            PipelineMaterial.Paint(renderer, Color.white);
            renderer.material.mainTexture = (Texture2D)keep(Shapes.Picture(Texels, Texels, Pixels((ring, wear) =>
                Color32.Lerp(Ceramic, Jute, ring * (1f - 0.5f * wear)))));
            var collider = owner.AddComponent<MeshCollider>();
            collider.sharedMesh = mesh;
            return collider;
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
}
