#nullable enable
using System.Collections.Generic;
using UnityEngine;

namespace HaptoFlow.Samples.Workshop
{
    /// <summary>Builds the sample when it wakes: a bench of things that nobody tagged. A map's rules say what each
    /// thing feels like: a terrain by its layers, a board by the materials that it is drawn with, a plate by a mask.
    /// </summary>
    [RequireComponent(typeof(PipelineMaterial))]
    public sealed class WorkshopScene : MonoBehaviour
    {
        private const string Hint = "hold the left mouse button and draw: the line above says why it feels so";
        private const int Water = 4;

        private readonly List<Object> made = new List<Object>();

        [SerializeField, Tooltip("Counts where the project's settings name no model.")]
        private HapticModelAsset? model;

        [SerializeField]
        private Camera? view;

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

        /// <summary>The scene's rules.</summary>
        public HapticMaterialMap Map { get; private set; } = null!;

        /// <summary>Feels like its layers, mixed as they are painted.</summary>
        public Terrain Garden { get; private set; } = null!;

        /// <summary>Left of its middle it is drawn, and feels, like oak; right of it like steel mesh.</summary>
        public MeshCollider Halves { get; private set; } = null!;

        /// <summary>A pane with a ring of jute let into it, worn away towards one side.</summary>
        public MeshCollider Inlay { get; private set; } = null!;

        /// <summary>Feels like <see cref="SpecimenMaterial"/>.</summary>
        public GameObject Specimen { get; private set; } = null!;

        /// <summary>What a panel may change, to put a new material under the pen.</summary>
        public HapticMaterial SpecimenMaterial { get; private set; } = null!;

        /// <summary>Where a panel that adds a material stands: beside the specimen, facing the player.</summary>
        public Transform PanelPlace { get; private set; } = null!;

        /// <summary>The pen under the mouse.</summary>
        public MousePen Pen { get; private set; } = null!;

        private void Awake()
        {
            HaptoFlowSettings settings = HaptoFlowSettings.Active;
            if (settings.Model == null)
            {
                settings.Model = model;
            }
            Quaternion facing = view!.transform.rotation;
            Map = Keep(ScriptableObject.CreateInstance<HapticMaterialMap>());
            Map.name = "Workshop";
            MakeSolids();
            Garden = new GardenBed(new Vector3(-0.45f, 0.001f, -0.02f), Keep).Build(Map, Feeling);
            Halves = new TwoHalves(new Vector3(0.24f, 0f, 0.11f), Keep).Build(Map, Feeling);
            Inlay = new InlaidPane(new Vector3(-0.25f, 0f, -0.16f), Keep).Build(Map, Feeling);
            // Behind all others: what they match is decided.
            Map.Add(HapticMaterialRule.ForName("Bench", Feeling("wood")));
            gameObject.AddComponent<HapticMaterialMapScope>().Map = Map;
            Pen = MousePen.Create(view);
            WhyBoard.Create(Pen.Stylus, new Vector3(0f, 0.2f, 0.32f), facing);
            StatusBoard.Create(Pen.Stylus, Hint, new Vector3(0f, 0.16f, 0.3f), facing);
        }

        private void OnDestroy()
        {
            foreach (Object each in made)
            {
                Destroy(each);
            }
        }

        private void MakeSolids()
        {
            Build.Solid("Bench", PrimitiveType.Cube, new Vector3(0f, -0.01f, 0f), new Vector3(1f, 0.02f, 0.6f),
                new Color(0.73f, 0.47f, 0.25f));
            GameObject puddle = Build.Solid("Puddle", PrimitiveType.Cube, new Vector3(0.02f, 0.001f, -0.16f),
                new Vector3(0.16f, 0.002f, 0.14f), new Color(0.45f, 0.66f, 0.85f));
            puddle.layer = Water;
            Map.Add(HapticMaterialRule.ForLayer(Water, Feeling("glass")));
            Specimen = Build.Solid("Specimen", PrimitiveType.Cube, new Vector3(0.27f, 0.004f, -0.16f),
                new Vector3(0.2f, 0.008f, 0.14f), new Color(0.82f, 0.8f, 0.76f));
            SpecimenMaterial = Feeling("cardboard");
            Map.Add(HapticMaterialRule.ForName("Specimen", SpecimenMaterial));
            PanelPlace = new GameObject("Panel Place").transform;
            PanelPlace.SetPositionAndRotation(new Vector3(0.27f, 0.03f, -0.26f), view!.transform.rotation);
        }

        private HapticMaterial Feeling(string label)
        {
            HapticMaterial material = Keep(ScriptableObject.CreateInstance<HapticMaterial>());
            material.name = label;
            material.Description.Label = label;
            return material;
        }

        /// <summary>What is made here goes with the scene.</summary>
        private T Keep<T>(T asset)
            where T : Object
        {
            made.Add(asset);
            return asset;
        }
    }
}
