#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Model;
using UnityEngine;

namespace HaptoFlow.Samples.TextureGallery
{
    /// <summary>Builds the sample when it wakes: a tile for each label of the model, and a wide board that takes the
    /// label of the tile that was pressed last.</summary>
    [RequireComponent(typeof(PipelineMaterial))]
    public sealed class GalleryScene : MonoBehaviour
    {
        private const string Hint = "press a tile to pick its label; stroke the tile, or the board below";
        private const float BoardHeight = 0.16f;

        // In front of the tiles and below them.
        private const float NameAhead = -0.012f;
        private const float NameBelow = -0.055f;

        private readonly List<HapticSurface> tiles = new List<HapticSurface>();

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

        /// <summary>Who looks at the wall. To be set before the component wakes.</summary>
        public Camera? View
        {
            get => view;
            set => view = value;
        }

        /// <summary>One for each label of the model, in the model's order.</summary>
        public IReadOnlyList<HapticSurface> Tiles => tiles;

        /// <summary>What takes the picked label.</summary>
        public HapticSurface Board { get; private set; } = null!;

        /// <summary>The pen under the mouse.</summary>
        public MousePen Pen { get; private set; } = null!;

        private void Awake()
        {
            HaptoFlowSettings settings = HaptoFlowSettings.Active;
            if (settings.Model == null)
            {
                settings.Model = model;
            }
            IReadOnlyList<ModelLabel> labels = settings.Model != null
                ? settings.Model.Header.Labels
                : Array.Empty<ModelLabel>();
            var wall = new Wall(Math.Max(1, labels.Count));
            for (int index = 0; index < labels.Count; ++index)
            {
                AddTile(labels[index].Name, wall.Place(index), ColourOf(index, labels.Count));
            }
            float boardPlace = -0.5f * (wall.Size.y + BoardHeight);
            Board = Tagged("Board", labels.Count > 0 ? labels[0].Name : "", new Vector3(0f, boardPlace, 0f),
                new Vector3(wall.Size.x, BoardHeight, Wall.TileSize.z), new Color(0.82f, 0.8f, 0.76f));
            Pen = MousePen.Create(view!);
            Pen.Stylus.TouchBegan += Pick;
            var place = new Vector3(0f, boardPlace - 0.5f * BoardHeight - 0.04f, 0f);
            StatusBoard.Create(Pen.Stylus, Hint, place, Quaternion.identity);
        }

        private void Pick(HapticStylus stylus, in HapticContact contact)
        {
            if (contact.Material != null && contact.Surface != Board)
            {
                Board.Material.Label = contact.Material.Label;
                Board.GetComponent<MeshRenderer>().material.color =
                    contact.Collider.GetComponent<MeshRenderer>().material.color;
            }
        }

        private void AddTile(string label, Vector3 place, Color colour)
        {
            tiles.Add(Tagged(label, label, place, Wall.TileSize, colour));
            Build.Text(label, place + new Vector3(0f, NameBelow, NameAhead), Quaternion.identity);
        }

        private static HapticSurface Tagged(string name, string label, Vector3 place, Vector3 size, Color colour) =>
            Build.Tag(Build.Solid(name, PrimitiveType.Cube, place, size, colour), label);

        private static Color ColourOf(int index, int count) => Color.HSVToRGB((float)index / count, 0.45f, 0.85f);
    }
}
