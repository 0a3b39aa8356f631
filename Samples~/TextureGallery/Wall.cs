#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow.Samples.TextureGallery
{
    /// <summary>Places tiles on a wall that faces -z, row by row from the upper left.</summary>
    public readonly struct Wall
    {
        private const float StepRight = 0.15f;
        private const float StepDown = 0.13f;
        private readonly int columns;
        private readonly int rows;

        /// <param name="tiles">How many; 1 or more.</param>
        public Wall(int tiles)
        {
            columns = (int)Math.Ceiling(Math.Sqrt(1.25 * tiles));
            rows = (tiles + columns - 1) / columns;
        }

        /// <summary>Of a tile, in metres.</summary>
        public static Vector3 TileSize => new Vector3(0.13f, 0.09f, 0.02f);

        /// <summary>Of all tiles together, in metres.</summary>
        public Vector3 Size => new Vector3(StepRight * columns, StepDown * rows, TileSize.z);

        /// <summary>Centre of a tile: the wall's own centre is the origin.</summary>
        public Vector3 Place(int tile) => new Vector3(
            StepRight * (tile % columns - 0.5f * (columns - 1)), StepDown * (0.5f * (rows - 1) - tile / columns), 0f);
    }
}
