#nullable enable
using System;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.SampleScenes
{
    /// <summary>A mesh of two submeshes, each drawn with its own material. The rules match these materials.</summary>
    internal sealed class TwoHalves
    {
        private static readonly Vector3 Half = new Vector3(0.19f, 0.012f, 0.22f);

        /// <summary>The size of both halves together, in metres.</summary>
        public static readonly Vector3 Size = new Vector3(2f * Half.x, Half.y, Half.z);

        private static readonly (string Paint, string Label, Color Colour)[] Sides =
        {
            ("Oak", "wood", new Color(0.64f, 0.45f, 0.25f)), ("Steel", "metal mesh", new Color(0.55f, 0.6f, 0.68f)),
        };

        private readonly Vector3 place;
        private readonly Func<Object, Object> keep;

        /// <param name="place">The position of the middle of its underside.</param>
        /// <param name="keep">Marks an asset to be destroyed with the scene.</param>
        public TwoHalves(Vector3 place, Func<Object, Object> keep) => (this.place, this.keep) = (place, keep);

        public MeshCollider Build(HapticMaterialMap map, Func<string, HapticMaterial> createMaterial)
        {
            var owner = new GameObject("Two Halves");
            owner.transform.position = place;
            var left = new Vector3(-0.5f * Half.x, 0.5f * Half.y, 0f);
            var mesh = (Mesh)keep(Shapes.Boxes(
                Half, left, new Vector3(-left.x, left.y, left.z)));
            owner.AddComponent<MeshFilter>().sharedMesh = mesh;
            var renderer = owner.AddComponent<MeshRenderer>();
            PipelineMaterial.Paint(renderer, Color.white);
            var paints = new Material[Sides.Length];
            for (int side = 0; side < Sides.Length; ++side)
            {
                paints[side] = (Material)keep(new Material(renderer.sharedMaterial!));
                paints[side].name = Sides[side].Paint;
                paints[side].color = Sides[side].Colour;
                map.Add(HapticMaterialRule.ForRendererMaterial(paints[side], createMaterial(Sides[side].Label)));
            }
            renderer.sharedMaterials = paints;
            var collider = owner.AddComponent<MeshCollider>();
            collider.sharedMesh = mesh;
            return collider;
        }
    }
}
