#nullable enable
using HaptoFlow.Studies;
using UnityEngine;

namespace HaptoFlow.Samples.LatencyStudy
{
    /// <summary>Builds the sample when it wakes: a plate, the marker over it, a panel, a pen, an output on a channel of
    /// its own, noise on the others, and the study that leads through it.</summary>
    [RequireComponent(typeof(PipelineMaterial))]
    public sealed class LatencyStudyScene : MonoBehaviour
    {
        // Lower than a mouse pen's reach, and as high as a hand on a table.
        private static readonly Vector3 PlateSize = new Vector3(0.3f, 0.02f, 0.22f);

        [SerializeField, Tooltip("Counts where the project's settings name no model.")]
        private HapticModelAsset? model;

        [SerializeField, Tooltip("The camera with the Audio Listener.")]
        private Camera? view;

        [SerializeField, Tooltip("What the laboratory decided.")]
        private LatencyStudySettings? settings;

        /// <summary>Counts where the project's settings name no model. To be set before the component wakes.</summary>
        public HapticModelAsset? Model
        {
            get => model;
            set => model = value;
        }

        /// <summary>The participant's eye, with the Audio Listener. To be set before the component wakes.</summary>
        public Camera? View
        {
            get => view;
            set => view = value;
        }

        /// <summary>What the laboratory decided. To be set before the component wakes.</summary>
        public LatencyStudySettings? Settings
        {
            get => settings;
            set => settings = value;
        }

        /// <summary>What leads through the study.</summary>
        public LatencyStudy Study { get; private set; } = null!;

        private void Awake()
        {
            HaptoFlowSettings active = HaptoFlowSettings.Active;
            if (active.Model == null)
            {
                active.Model = model;
            }
            LatencyStudySettings chosen = settings != null
                ? settings
                : ScriptableObject.CreateInstance<LatencyStudySettings>();
            GameObject plate = Build.Solid("Plate", PrimitiveType.Cube, new Vector3(0f, -0.5f * PlateSize.y, 0f),
                PlateSize, new Color(0.35f, 0.37f, 0.4f));
            Build.Tag(plate, "wood");
            HapticOutput output = MakeOutput(view!.gameObject, chosen);
            Study = gameObject.AddComponent<LatencyStudy>();
            Study.Prepare(chosen, output, view.GetComponent<MaskingNoise>(), Marker.Create(chosen, Vector3.zero),
                QuestionPanel.Create(new Vector3(0f, 0.14f, 0.24f), view.transform.rotation),
                gameObject.AddComponent<OperatorView>());
            HapticStylus mouse = MousePen.Create(view).Stylus;
            mouse.Output = output;
            Study.AddPen(mouse);
#if HAPTOFLOW_INPUT_SYSTEM && ENABLE_INPUT_SYSTEM
            StudyRig rig = StudyRig.Create(view, chosen.PenHand);
            rig.WithoutHeadset = mouse.gameObject;
            HapticStylus held = rig.Pen.Stylus!;
            held.Output = output;
            Study.AddPen(held);
#endif
        }

        private static HapticOutput MakeOutput(GameObject ears, LatencyStudySettings settings)
        {
            var noise = ears.AddComponent<MaskingNoise>();
            noise.Colour = settings.NoiseColour;
            noise.LevelDecibels = settings.NoiseDecibels;
            // Behind the noise: the output overwrites its channel.
            var output = ears.AddComponent<HapticOutput>();
            output.Route = OutputRoute.ListenerChannel;
            output.Channel = settings.HapticChannel;
            noise.Output = output;
            return output;
        }
    }
}
