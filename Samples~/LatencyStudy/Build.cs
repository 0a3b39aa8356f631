#nullable enable
using UnityEngine;

namespace HaptoFlow.Samples.LatencyStudy
{
    /// <summary>Makes the objects of a sample's scene.</summary>
    public static class Build
    {
        // Readable from half a metre.
        private const float LetterMetres = 0.0022f;
        private const int FontSize = 48;

        /// <summary>A primitive with its collider.</summary>
        /// <param name="size">In metres, along the object's own axes.</param>
        public static GameObject Solid(string name, PrimitiveType shape, Vector3 position, Vector3 size, Color colour)
        {
            GameObject made = GameObject.CreatePrimitive(shape);
            // Players leave out engine types that no script names, and primitives need this one.
            _ = made.GetComponent<MeshFilter>();
            made.name = name;
            made.transform.position = position;
            // A capsule is two units high.
            bool isTall = shape == PrimitiveType.Capsule;
            made.transform.localScale = isTall ? new Vector3(size.x, 0.5f * size.y, size.z) : size;
            PipelineMaterial.Paint(made.GetComponent<MeshRenderer>(), colour);
            return made;
        }

        /// <summary>Tags an object with a label of the model.</summary>
        public static HapticSurface Tag(GameObject owner, string label)
        {
            var surface = owner.AddComponent<HapticSurface>();
            surface.Material.Label = label;
            return surface;
        }

        /// <summary>A line of text that can be read from its back side along z, as all text in Unity.</summary>
        public static TextMesh Text(string text, Vector3 position, Quaternion rotation)
        {
            var owner = new GameObject("Text");
            owner.transform.SetPositionAndRotation(position, rotation);
            // The renderer comes first: a text mesh alone has none.
            var renderer = owner.AddComponent<MeshRenderer>();
            var made = owner.AddComponent<TextMesh>();
            made.font = Resources.GetBuiltinResource<Font>("LegacyRuntime.ttf");
            renderer.material = made.font.material;
            made.fontSize = FontSize;
            made.characterSize = LetterMetres;
            made.anchor = TextAnchor.MiddleCenter;
            made.alignment = TextAlignment.Center;
            made.color = Color.white;
            made.text = text;
            return made;
        }
    }
}
