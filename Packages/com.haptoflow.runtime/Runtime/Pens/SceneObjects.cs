#nullable enable
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Creates objects and text for scenes that a script builds, as the package's samples do. The objects are
    /// drawn in the Built-in, Universal and High Definition render pipelines. Main thread, in play mode.</summary>
    public static class SceneObjects
    {
        // Readable from half a metre.
        private const float CharacterSize = 0.0022f;
        private const int FontSize = 48;

        /// <summary>Creates a primitive with its collider.</summary>
        /// <param name="size">In metres, along the object's own axes.</param>
        public static GameObject AddSolid(
            string name, PrimitiveType shape, Vector3 position, Vector3 size, Color colour)
        {
            GameObject solid = GameObject.CreatePrimitive(shape);
            // Player builds strip engine types that no script names; primitives need the MeshFilter.
            _ = solid.GetComponent<MeshFilter>();
            solid.name = name;
            solid.transform.position = position;
            // Unity's capsule is two units high, all other primitives are one.
            bool isTall = shape == PrimitiveType.Capsule;
            solid.transform.localScale = isTall ? new Vector3(size.x, 0.5f * size.y, size.z) : size;
            PipelineMaterial.Paint(solid.GetComponent<MeshRenderer>(), colour);
            return solid;
        }

        /// <summary>Creates a primitive that the pen passes through: its collider is disabled.</summary>
        /// <param name="size">In metres, along the object's own axes.</param>
        public static GameObject AddMark(
            string name, PrimitiveType shape, Vector3 position, Vector3 size, Color colour)
        {
            GameObject mark = AddSolid(name, shape, position, size, colour);
            mark.GetComponent<Collider>().enabled = false;
            return mark;
        }

        /// <summary>Adds a <see cref="HapticSurface"/> with a material label to an object.</summary>
        public static HapticSurface AddSurface(GameObject owner, string label)
        {
            var surface = owner.AddComponent<HapticSurface>();
            surface.Material.Label = label;
            return surface;
        }

        /// <summary>Creates a line of white text, centred at a position. As all text in Unity, it reads along its own z
        /// axis: the rotation of the camera makes it face the camera.</summary>
        public static TextMesh AddText(string text, Vector3 position, Quaternion rotation)
        {
            var owner = new GameObject("Text");
            owner.transform.SetPositionAndRotation(position, rotation);
            // A TextMesh does not add the renderer that it needs.
            var renderer = owner.AddComponent<MeshRenderer>();
            var mesh = owner.AddComponent<TextMesh>();
            mesh.font = Resources.GetBuiltinResource<Font>("LegacyRuntime.ttf");
            renderer.material = mesh.font.material;
            mesh.fontSize = FontSize;
            mesh.characterSize = CharacterSize;
            mesh.anchor = TextAnchor.MiddleCenter;
            mesh.alignment = TextAlignment.Center;
            mesh.color = Color.white;
            mesh.text = text;
            return mesh;
        }
    }

    /// <summary>Draws solids in the scene view, for scenes that a script builds when they are played: without them such
    /// a scene looks empty in the editor. Main thread, from OnDrawGizmos.</summary>
    public static class SceneSketch
    {
        /// <summary>Draws a solid. Everything but a cube is drawn as an ellipsoid.</summary>
        /// <param name="size">In metres, along the solid's own axes.</param>
        public static void Draw(PrimitiveType shape, Vector3 position, Quaternion rotation, Vector3 size, Color colour)
        {
            Matrix4x4 before = Gizmos.matrix;
            Gizmos.matrix = Matrix4x4.TRS(position, rotation, size);
            Gizmos.color = colour;
            if (shape == PrimitiveType.Cube)
            {
                Gizmos.DrawCube(Vector3.zero, Vector3.one);
            }
            else
            {
                Gizmos.DrawSphere(Vector3.zero, 0.5f);
            }
            Gizmos.matrix = before;
        }

        /// <summary>Draws a cuboid along the axes of the world.</summary>
        /// <param name="size">In metres.</param>
        public static void DrawBox(Vector3 centre, Vector3 size, Color colour) =>
            Draw(PrimitiveType.Cube, centre, Quaternion.identity, size, colour);
    }

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
