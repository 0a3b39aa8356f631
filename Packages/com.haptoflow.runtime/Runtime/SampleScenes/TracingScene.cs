#nullable enable
using UnityEngine;

namespace HaptoFlow.SampleScenes
{
    /// <summary>Builds the sample when it wakes: a table with objects of eight labels, a pen under the mouse, and a pen
    /// for each hand that holds a tracked stylus or controller.</summary>
    internal sealed class TracingScene : BuiltScene
    {
        private const string Hint = "hold the left mouse button and draw over the objects";

        /// <summary>The name under which the alignment of the table with a real one is kept between sessions; empty to
        /// keep nothing. Set it before the component wakes.</summary>
        public string SaveName { get; set; } = "StylusTracing";

        public MousePen Pen { get; private set; } = null!;

        public override void Sketch()
        {
            foreach (Exhibit each in Exhibits.All)
            {
                SceneSketch.Draw(each.Shape, each.Position, each.Rotation, each.Size, each.Colour);
            }
        }

        private void Awake()
        {
            UseModelIfNoneIsSet();
            var exhibits = new GameObject("Exhibits");
            foreach (Exhibit exhibit in Exhibits.All)
            {
                Add(exhibit, exhibits.transform);
            }
            Pen = MousePen.Create(View!);
            Quaternion facing = View!.transform.rotation;
            StatusBoard.Create(Pen.Stylus, Hint, new Vector3(0f, 0.16f, 0.3f), facing);
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
            XrRig rig = XrRig.Create(View);
            rig.AddPen(PenHand.Right);
            rig.AddPen(PenHand.Left);
            AlignmentStep.Create(exhibits, SaveName, facing);
            OutputStep.Create(facing);
#endif
        }

        private static void Add(Exhibit exhibit, Transform parent)
        {
            GameObject solid = SceneObjects.AddSolid(
                exhibit.Name, exhibit.Shape, exhibit.Position, exhibit.Size, exhibit.Colour);
            solid.transform.rotation = exhibit.Rotation;
            solid.transform.SetParent(parent, true);
            HapticSurface surface = SceneObjects.AddSurface(solid, exhibit.Label);
            // A capsule is long in y, all other shapes in x.
            surface.Grain = exhibit.Shape == PrimitiveType.Capsule ? Vector3.up : Vector3.right;
            if (exhibit.Slides)
            {
                solid.AddComponent<Rigidbody>();
                solid.AddComponent<SlidingMotion>();
            }
        }
    }

    /// <summary>One object of the sample.</summary>
    /// <param name="Size">The size along the axes of the object, in metres.</param>
    internal sealed record Exhibit(string Name, string Label, PrimitiveType Shape, Vector3 Position, Vector3 Size,
        Color Colour, Quaternion? Turned = null, bool Slides = false)
    {
        public Quaternion Rotation => Turned ?? Quaternion.identity;
    }

    /// <summary>The objects of the sample. StylusTracing.scene.json holds them for the command line.</summary>
    internal static class Exhibits
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
                Slides: true),
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
