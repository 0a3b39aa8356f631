#nullable enable
using UnityEngine;

namespace HaptoFlow.Samples.StylusTracing
{
    /// <summary>Builds the sample when it wakes: a table with objects of eight labels, a pen under the mouse, and one
    /// for each hand that holds a tracked stylus or controller.</summary>
    [RequireComponent(typeof(PipelineMaterial))]
    public sealed class TracingScene : MonoBehaviour
    {
        private const string Hint = "hold the left mouse button and draw over the objects";

        [SerializeField, Tooltip("Counts where the project's settings name no model.")]
        private HapticModelAsset? model;

        [SerializeField]
        private Camera? view;

        /// <summary>Where the table was put onto a real one is kept under this name; empty to keep nothing. To be set
        /// before the component wakes.</summary>
        public string SaveName { get; set; } = "StylusTracing";

        /// <summary>Counts where the project's settings name no model. To be set before the component wakes.</summary>
        public HapticModelAsset? Model
        {
            get => model;
            set => model = value;
        }

        /// <summary>The player's eye. To be set before the component wakes.</summary>
        public Camera? View
        {
            get => view;
            set => view = value;
        }

        /// <summary>The pen under the mouse.</summary>
        public MousePen Pen { get; private set; } = null!;

        private void Awake()
        {
            HaptoFlowSettings settings = HaptoFlowSettings.Active;
            if (settings.Model == null)
            {
                settings.Model = model;
            }
            var exhibits = new GameObject("Exhibits");
            foreach (Exhibit exhibit in Exhibits.All)
            {
                Show(exhibit, exhibits.transform);
            }
            Pen = MousePen.Create(view!);
            Quaternion facing = view!.transform.rotation;
            StatusBoard.Create(Pen.Stylus, Hint, new Vector3(0f, 0.16f, 0.3f), facing);
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
            XrRig.Create(view!);
            AlignmentStep.Create(exhibits, SaveName, facing);
            OutputStep.Create(facing);
#endif
        }

        private static void Show(in Exhibit exhibit, Transform parent)
        {
            GameObject made = Build.Solid(exhibit.Name, exhibit.Shape, exhibit.Position, exhibit.Size, exhibit.Colour);
            made.transform.rotation = exhibit.Rotation;
            made.transform.SetParent(parent, true);
            HapticSurface surface = Build.Tag(made, exhibit.Label);
            // A capsule's length is its own y axis.
            surface.Grain = exhibit.Shape == PrimitiveType.Capsule ? Vector3.up : Vector3.right;
            if (exhibit.Slides)
            {
                made.AddComponent<Rigidbody>();
                made.AddComponent<SlidingMotion>();
            }
        }
    }
}
