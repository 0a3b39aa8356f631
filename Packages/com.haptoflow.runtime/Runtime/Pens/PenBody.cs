#nullable enable
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>The visible body of a pen.</summary>
    internal static class PenBody
    {
        public const string Name = "Body";
        private const float LengthMetres = 0.14f;
        private const float WidthMetres = 0.008f;

        /// <summary>Adds a body without collisions above a tip. Main thread, also in edit mode.</summary>
        public static void Add(Transform tip, Color colour)
        {
            GameObject body = GameObject.CreatePrimitive(PrimitiveType.Capsule);
            // Players strip engine types that no script references, and primitives need this one.
            _ = body.GetComponent<MeshFilter>();
            body.name = Name;
            body.GetComponent<Collider>().enabled = false;
            body.transform.SetParent(tip, false);
            body.transform.localPosition = new Vector3(0f, 0.5f * LengthMetres, 0f);
            // A capsule is two units high.
            body.transform.localScale = new Vector3(WidthMetres, 0.5f * LengthMetres, WidthMetres);
            body.AddComponent<PipelineMaterial>().Colour = colour;
        }
    }
}
