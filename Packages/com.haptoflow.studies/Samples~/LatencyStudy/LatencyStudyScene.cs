#nullable enable
using HaptoFlow.Studies;
using UnityEngine;

namespace HaptoFlow.Samples.LatencyStudy
{
    /// <summary>Builds the sample when it wakes: a plate with the marker on it, a panel for the participant, a pen, a
    /// haptic output on a channel of its own, noise on the other channels, and the study's procedure. The scene's
    /// camera has to carry the Audio Listener.</summary>
    public sealed class LatencyStudyScene : BuiltScene
    {
        // The top of the plate is at y = 0.
        private static readonly Vector3 PlateSize = new Vector3(0.3f, 0.02f, 0.22f);
        private static readonly Vector3 PlatePlace = new Vector3(0f, -0.5f * PlateSize.y, 0f);
        private static readonly Color PlateColour = new Color(0.35f, 0.37f, 0.4f);

        [SerializeField, Tooltip("The settings hold everything that a laboratory decides about the study.")]
        private LatencyStudySettings? settings;

        /// <summary>Everything that a laboratory decides; null for the defaults. Set it before the component wakes.
        /// </summary>
        public LatencyStudySettings? Settings { get => settings; set => settings = value; }

        public LatencyStudy Study { get; private set; } = null!;

        /// <inheritdoc/>
        public override void Sketch() => SceneSketch.DrawBox(PlatePlace, PlateSize, PlateColour);

        private void Awake()
        {
            UseModelIfNoneIsSet();
            LatencyStudySettings chosen = settings != null
                ? settings
                : ScriptableObject.CreateInstance<LatencyStudySettings>();
            GameObject plate = SceneObjects.AddSolid("Plate", PrimitiveType.Cube,
                PlatePlace, PlateSize, PlateColour);
            SceneObjects.AddSurface(plate, "wood");
            HapticOutput output = chosen.AddOutput(View!.gameObject, out MaskingNoise noise);
            Study = gameObject.AddComponent<LatencyStudy>();
            Study.Prepare(chosen, output, noise, Marker.Create(chosen, Vector3.zero),
                SceneObjects.AddText("", new Vector3(0f, 0.14f, 0.24f), View.transform.rotation),
                gameObject.AddComponent<OperatorView>());
            MousePen mouse = MousePen.Create(View);
            mouse.Stylus.Output = output;
            Study.AddPen(mouse.Stylus);
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
            XrRig rig = XrRig.Create(View);
            rig.MousePen = mouse;
            HapticStylus held = rig.AddPen(chosen.penHand).Stylus!;
            held.Output = output;
            Study.AddPen(held);
#endif
        }
    }
}
