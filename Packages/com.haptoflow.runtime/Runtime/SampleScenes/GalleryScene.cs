#nullable enable
using System;
using System.Collections.Generic;
using UnityEngine;

namespace HaptoFlow.SampleScenes
{
    /// <summary>Builds the sample when it wakes: a tile for each label of the model, and a wide board that takes the
    /// label of the tile that was pressed last.</summary>
    internal sealed class GalleryScene : BuiltScene
    {
        private const string Hint = "press a tile to pick its label; stroke the tile, or the board below";
        private const float BoardHeight = 0.16f;

        // The offset of a label's text from the centre of its tile, in metres: in front of the tile and below it.
        private const float TextOffsetZ = -0.012f;
        private const float TextOffsetY = -0.055f;

        private static readonly Color BoardColour = new Color(0.82f, 0.8f, 0.76f);

        private readonly List<HapticSurface> tiles = new List<HapticSurface>();

        public IReadOnlyList<HapticSurface> Tiles => tiles;

        public HapticSurface Board { get; private set; } = null!;

        public MousePen Pen { get; private set; } = null!;

        public override void Sketch()
        {
            int labels = LabelsOfModel().Count;
            var wall = new Wall(Math.Max(1, labels));
            for (int index = 0; index < labels; ++index)
            {
                SceneSketch.DrawBox(wall.Place(index), Wall.TileSize, ColourOf(index, labels));
            }
            SceneSketch.DrawBox(PlaceOfBoard(wall), SizeOfBoard(wall), BoardColour);
        }

        private static Vector3 PlaceOfBoard(in Wall wall) =>
            new Vector3(0f, -0.5f * (wall.Size.y + BoardHeight), 0f);

        private static Vector3 SizeOfBoard(in Wall wall) =>
            new Vector3(wall.Size.x, BoardHeight, Wall.TileSize.z);

        private void Awake()
        {
            UseModelIfNoneIsSet();
            IReadOnlyList<HapticLabel> labels = LabelsOfModel();
            var wall = new Wall(Math.Max(1, labels.Count));
            for (int index = 0; index < labels.Count; ++index)
            {
                AddTile(labels[index].Name, wall.Place(index), ColourOf(index, labels.Count));
            }
            Vector3 board = PlaceOfBoard(wall);
            Board = AddCube("Board", labels.Count > 0 ? labels[0].Name : "", board, SizeOfBoard(wall), BoardColour);
            Pen = MousePen.Create(View!);
            Pen.Stylus.TouchBegan += PickLabel;
            Vector3 place = board - new Vector3(0f, 0.5f * BoardHeight + 0.04f, 0f);
            StatusBoard.Create(Pen.Stylus, Hint, place, Quaternion.identity);
        }

        private void PickLabel(HapticStylus stylus, in HapticContact contact)
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
            tiles.Add(AddCube(label, label, place, Wall.TileSize, colour));
            SceneObjects.AddText(label, place + new Vector3(0f, TextOffsetY, TextOffsetZ), Quaternion.identity);
        }

        private static HapticSurface AddCube(string name, string label, Vector3 place, Vector3 size, Color colour) =>
            SceneObjects.AddSurface(SceneObjects.AddSolid(name, PrimitiveType.Cube, place, size, colour), label);

        private static Color ColourOf(int index, int count) => Color.HSVToRGB((float)index / count, 0.45f, 0.85f);
    }

    /// <summary>Arranges tiles on a wall that faces -z, row by row from the upper left.</summary>
    internal readonly struct Wall
    {
        private const float ColumnStep = 0.15f;
        private const float RowStep = 0.13f;
        private readonly int columns;
        private readonly int rows;

        public Wall(int tiles)
        {
            columns = (int)Math.Ceiling(Math.Sqrt(1.25 * tiles));
            rows = (tiles + columns - 1) / columns;
        }

        public static Vector3 TileSize => new Vector3(0.13f, 0.09f, 0.02f);

        public Vector3 Size => new Vector3(ColumnStep * columns, RowStep * rows, TileSize.z);

        /// <summary>The centre of a tile, relative to the centre of the wall.</summary>
        public Vector3 Place(int tile) => new Vector3(
            ColumnStep * (tile % columns - 0.5f * (columns - 1)), RowStep * (0.5f * (rows - 1) - tile / columns), 0f);
    }
}
