#nullable enable
using System;

namespace HaptoFlow
{
    /// <summary>The heights of a relief as they were at one moment: another object is other heights. Immutable; any
    /// thread.</summary>
    internal sealed class ReliefHeights
    {
        private readonly ushort[] shares;
        private readonly int columns;
        private readonly int rows;

        /// <param name="shares">Of the depth, 0 to 65535, row by row from the bottom; not changed afterwards.</param>
        public ReliefHeights(ushort[] shares, int columns)
        {
            this.shares = shares;
            this.columns = columns;
            rows = shares.Length / columns;
        }

        /// <summary>Length of the map along its columns and its rows.</summary>
        public (float Columns, float Rows) SizeMetres { get; set; }

        public float DepthMetres { get; set; }

        public float TipRadiusMetres { get; set; }

        public bool IsTiled { get; set; }

        /// <summary>The height of the map at a place, between its texels; not a number at a place that is none.
        /// </summary>
        /// <remarks>The library draws a cubic spline through the texels, widens it by the tip's ball, and smooths what
        /// passes faster than a tip feels: this is what the map says, for a picture.</remarks>
        public double MetresAt(in MapPlace place)
        {
            if (float.IsNaN(place.Column + place.Row) || float.IsInfinity(place.Column + place.Row))
            {
                return double.NaN;
            }
            (int column, double right) = Between(place.Column, columns);
            (int row, double up) = Between(place.Row, rows);
            double lower = At(column, row) + right * (At(column + 1, row) - At(column, row));
            double upper = At(column, row + 1) + right * (At(column + 1, row + 1) - At(column, row + 1));
            return DepthMetres * (lower + up * (upper - lower)) / ushort.MaxValue;
        }

        /// <summary>Makes the library's copy, which the caller disposes.</summary>
        /// <exception cref="HaptoFlowException">As of <see cref="HapticReliefMap"/>.</exception>
        public HapticReliefMap MakeMap()
        {
            float metres = DepthMetres;
            return new HapticReliefMap(Array.ConvertAll(shares, share => metres * share / ushort.MaxValue), columns,
                SizeMetres, DepthMetres, TipRadiusMetres, IsTiled);
        }

        /// <summary>The texel whose middle is before a place, and the share of the way to the next.</summary>
        private (int Texel, double Share) Between(double place, int count)
        {
            double inMap = IsTiled ? place - Math.Floor(place) : Math.Max(-1.0, Math.Min(2.0, place));
            double texel = inMap * count - 0.5;
            double whole = Math.Floor(texel);
            return ((int)whole, texel - whole);
        }

        private double At(int column, int row) => shares[Index(row, rows) * columns + Index(column, columns)];

        private int Index(int texel, int count) => IsTiled
            ? (texel + count) % count
            : Math.Max(0, Math.Min(count - 1, texel));
    }
}
