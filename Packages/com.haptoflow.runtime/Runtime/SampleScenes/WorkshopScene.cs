#nullable enable
using System.Collections.Generic;
using System.Runtime.CompilerServices;
using UnityEngine;

[assembly: InternalsVisibleTo("HaptoFlow.Editor")]
[assembly: InternalsVisibleTo("HaptoFlow.EditorTests")]
[assembly: InternalsVisibleTo("HaptoFlow.SampleTests")]
[assembly: InternalsVisibleTo("HaptoFlow.Tests")]

namespace HaptoFlow.SampleScenes
{
    /// <summary>Builds the sample when it wakes: a bench of objects without Haptic Surface components. The rules of a
    /// Haptic Material Map assign their materials: to a terrain by its layers, to a board by its renderer's materials,
    /// to a pane by a mask.</summary>
    internal sealed class WorkshopScene : BuiltScene
    {
        private const string Hint = "hold the left mouse button and draw: the line above says why it feels so";
        private const int Water = 4;

        private static readonly Vector3 GardenCorner = new Vector3(-0.45f, 0.001f, -0.02f);
        private static readonly Vector3 HalvesPlace = new Vector3(0.24f, 0f, 0.11f);
        private static readonly Vector3 InlayPlace = new Vector3(-0.25f, 0f, -0.16f);
        private static readonly Color PaneColour = new Color(0.6f, 0.53f, 0.46f);
        private static readonly Solid Bench = new Solid("Bench",
            new Vector3(0f, -0.01f, 0f), new Vector3(1f, 0.02f, 0.6f), new Color(0.73f, 0.47f, 0.25f));
        private static readonly Solid Puddle = new Solid("Puddle",
            new Vector3(0.02f, 0.001f, -0.16f), new Vector3(0.16f, 0.002f, 0.14f), new Color(0.45f, 0.66f, 0.85f));
        private static readonly Solid SpecimenSolid = new Solid("Specimen",
            new Vector3(0.27f, 0.004f, -0.16f), new Vector3(0.2f, 0.008f, 0.14f), new Color(0.82f, 0.8f, 0.76f));

        private readonly List<Object> createdAssets = new List<Object>();

        public HapticMaterialMap Map { get; private set; } = null!;

        /// <summary>A terrain whose material is a blend of its layers, weighted as they are painted.</summary>
        public Terrain Garden { get; private set; } = null!;

        /// <summary>A board that looks and feels like oak in its left half, like steel mesh in its right.</summary>
        public MeshCollider Halves { get; private set; } = null!;

        /// <summary>A pane with an inlaid ring of jute that is worn away towards one side.</summary>
        public MeshCollider Inlay { get; private set; } = null!;

        public GameObject Specimen { get; private set; } = null!;

        /// <summary>The material of the specimen. A panel may change it, to let the pen feel a new material.</summary>
        public HapticMaterial SpecimenMaterial { get; private set; } = null!;

        /// <summary>The place of a panel that adds a material: beside the specimen, facing the camera.</summary>
        public Transform PanelPlace { get; private set; } = null!;

        public MousePen Pen { get; private set; } = null!;

        public override void Sketch()
        {
            foreach (Solid each in new[] { Bench, Puddle, SpecimenSolid })
            {
                SceneSketch.DrawBox(each.Place, each.Size, each.Colour);
            }
            SceneSketch.DrawBox(GardenCorner + 0.5f * GardenBed.Size, GardenBed.Size, PaneColour);
            SceneSketch.DrawBox(HalvesPlace + new Vector3(0f, 0.5f * TwoHalves.Size.y, 0f), TwoHalves.Size, PaneColour);
            SceneSketch.DrawBox(InlayPlace + new Vector3(0f, 0.5f * InlaidPane.Size.y, 0f), InlaidPane.Size, PaneColour);
        }

        private void Awake()
        {
            UseModelIfNoneIsSet();
            Quaternion facing = View!.transform.rotation;
            Map = Keep(ScriptableObject.CreateInstance<HapticMaterialMap>());
            Map.name = "Workshop";
            MakeSolids();
            Garden = GardenBed.Build(this, GardenCorner);
            Halves = TwoHalves.Build(this, HalvesPlace);
            Inlay = InlaidPane.Build(this, InlayPlace);
            // Last, because the first rule that matches decides.
            Map.Add(HapticMaterialRule.ForName("Bench", CreateMaterial("wood")));
            gameObject.AddComponent<HapticMaterialMapScope>().Map = Map;
            Pen = MousePen.Create(View);
            RuleBoard.Create(Pen.Stylus, new Vector3(0f, 0.2f, 0.32f), facing);
            StatusBoard.Create(Pen.Stylus, Hint, new Vector3(0f, 0.16f, 0.3f), facing);
        }

        private void OnDestroy()
        {
            foreach (Object each in createdAssets)
            {
                Destroy(each);
            }
        }

        private void MakeSolids()
        {
            Bench.Add();
            GameObject puddle = Puddle.Add();
            puddle.layer = Water;
            Map.Add(HapticMaterialRule.ForLayer(Water, CreateMaterial("glass")));
            Specimen = SpecimenSolid.Add();
            SpecimenMaterial = CreateMaterial("cardboard");
            Map.Add(HapticMaterialRule.ForName("Specimen", SpecimenMaterial));
            PanelPlace = new GameObject("Panel Place").transform;
            PanelPlace.SetPositionAndRotation(new Vector3(0.27f, 0.03f, -0.26f), View!.transform.rotation);
        }

        internal HapticMaterial CreateMaterial(string label)
        {
            HapticMaterial material = Keep(ScriptableObject.CreateInstance<HapticMaterial>());
            material.name = label;
            material.Description.Label = label;
            return material;
        }

        /// <summary>Marks an asset to be destroyed with the scene.</summary>
        internal T Keep<T>(T asset)
            where T : Object
        {
            createdAssets.Add(asset);
            return asset;
        }

        private sealed record Solid(string Name, Vector3 Place, Vector3 Size, Color Colour)
        {
            public GameObject Add() => SceneObjects.AddSolid(Name, PrimitiveType.Cube, Place, Size, Colour);
        }
    }
}
