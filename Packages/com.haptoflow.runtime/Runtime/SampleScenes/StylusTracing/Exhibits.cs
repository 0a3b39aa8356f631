#nullable enable
using UnityEngine;

namespace HaptoFlow.SampleScenes
{
    /// <summary>One object of the sample.</summary>
    public readonly struct Exhibit
    {
        internal Exhibit(string name, string label, PrimitiveType shape, Vector3 position, Vector3 size, Color colour,
            Quaternion? rotation = null, bool slides = false)
        {
            Name = name;
            Label = label;
            Shape = shape;
            Position = position;
            Size = size;
            Colour = colour;
            Rotation = rotation ?? Quaternion.identity;
            Slides = slides;
        }

        /// <summary>The name of the GameObject.</summary>
        public string Name { get; }

        /// <summary>The material label.</summary>
        public string Label { get; }

        /// <summary>The shape, which is drawn and felt.</summary>
        public PrimitiveType Shape { get; }

        /// <summary>The position of the centre, in metres.</summary>
        public Vector3 Position { get; }

        /// <summary>The size along the axes of the object, in metres.</summary>
        public Vector3 Size { get; }

        /// <summary>The colour.</summary>
        public Color Colour { get; }

        /// <summary>The rotation.</summary>
        public Quaternion Rotation { get; }

        /// <summary>Whether the object slides to and fro.</summary>
        public bool Slides { get; }
    }

    /// <summary>The objects of the sample. StylusTracing.scene.json holds them for the command line.</summary>
    public static class Exhibits
    {
        /// <summary>Objects of eight labels. The top of the table is the plane y = 0.</summary>
        public static readonly Exhibit[] All =
        {
            new Exhibit("Table", "wood", PrimitiveType.Cube,
                new Vector3(0f, -0.01f, 0f), new Vector3(1f, 0.02f, 0.6f), new Color(0.73f, 0.47f, 0.25f)),
            new Exhibit("Pebble", "stone", PrimitiveType.Sphere,
                new Vector3(-0.3f, -0.02f, 0.12f), new Vector3(0.2f, 0.2f, 0.2f), new Color(0.49f, 0.52f, 0.56f)),
            new Exhibit("Bolster", "corduroy", PrimitiveType.Capsule,
                new Vector3(0f, 0.035f, 0.12f), new Vector3(0.08f, 0.26f, 0.08f), new Color(0.56f, 0.37f, 0.66f),
                Quaternion.AngleAxis(90f, Vector3.forward)),
            new Exhibit("Sliding Grille", "metal mesh", PrimitiveType.Cube,
                new Vector3(0.3f, 0.016f, 0.12f), new Vector3(0.2f, 0.012f, 0.16f), new Color(0.36f, 0.5f, 0.71f),
                slides: true),
            new Exhibit("Sanding Block", "sandpaper", PrimitiveType.Cube,
                new Vector3(-0.34f, 0.01f, -0.12f), new Vector3(0.18f, 0.02f, 0.15f), new Color(0.85f, 0.55f, 0.18f)),
            new Exhibit("Tilted Pane", "glass", PrimitiveType.Cube,
                new Vector3(-0.115f, 0.02f, -0.12f), new Vector3(0.18f, 0.008f, 0.15f), new Color(0.44f, 0.72f, 0.77f),
                Quaternion.AngleAxis(-10f, Vector3.right)),
            new Exhibit("Mat", "rubber", PrimitiveType.Cube,
                new Vector3(0.115f, 0.003f, -0.12f), new Vector3(0.18f, 0.006f, 0.15f), new Color(0.36f, 0.33f, 0.4f)),
            new Exhibit("Sack", "jute", PrimitiveType.Cube,
                new Vector3(0.34f, 0.006f, -0.12f), new Vector3(0.18f, 0.012f, 0.15f), new Color(0.71f, 0.6f, 0.3f)),
        };
    }
}
