#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow.SampleScenes
{
    /// <summary>Arranges tiles on a wall that faces -z, row by row from the upper left.</summary>
    public readonly struct Wall
    {
        private const float ColumnStep = 0.15f;
        private const float RowStep = 0.13f;
        private readonly int columns;
        private readonly int rows;

        /// <param name="tiles">The number of tiles, 1 or more.</param>
        public Wall(int tiles)
        {
            columns = (int)Math.Ceiling(Math.Sqrt(1.25 * tiles));
            rows = (tiles + columns - 1) / columns;
        }

        /// <summary>The size of a tile, in metres.</summary>
        public static Vector3 TileSize => new Vector3(0.13f, 0.09f, 0.02f);

        /// <summary>The size of the whole wall, in metres.</summary>
        public Vector3 Size => new Vector3(ColumnStep * columns, RowStep * rows, TileSize.z);

        /// <summary>The centre of a tile, relative to the centre of the wall.</summary>
        public Vector3 Place(int tile) => new Vector3(
            ColumnStep * (tile % columns - 0.5f * (columns - 1)), RowStep * (0.5f * (rows - 1) - tile / columns), 0f);
    }
}
