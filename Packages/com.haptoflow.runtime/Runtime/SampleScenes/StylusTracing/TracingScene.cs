#nullable enable
using UnityEngine;

namespace HaptoFlow.SampleScenes
{
    /// <summary>Builds the sample when it wakes: a table with objects of eight labels, a pen under the mouse, and a pen
    /// for each hand that holds a tracked stylus or controller.</summary>
    public sealed class TracingScene : BuiltScene
    {
        private const string Hint = "hold the left mouse button and draw over the objects";

        /// <summary>The name under which the alignment of the table with a real one is kept between sessions; empty to
        /// keep nothing. Set it before the component wakes.</summary>
        public string SaveName { get; set; } = "StylusTracing";

        /// <summary>The pen under the mouse.</summary>
        public MousePen Pen { get; private set; } = null!;

        /// <inheritdoc/>
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

        private static void Add(in Exhibit exhibit, Transform parent)
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
}
