#nullable enable
using System;
using System.Threading;
using HaptoFlow.Native;

namespace HaptoFlow
{
    /// <summary>The heights of a surface in the native library, which a tip follows wherever a contact state names
    /// them, in every voice and engine. Any thread.</summary>
    public sealed unsafe class HapticReliefMap : IDisposable
    {
        /// <summary>The most texels of a map.</summary>
        public const int MaximumTexels = 3 << 20;

        private int number;

        /// <summary>Copies the heights. Takes about 0.1 s for 10^6 texels.</summary>
        /// <param name="heightsMetres">Row by row, columns * rows of them; limited to 0 to the depth.</param>
        /// <param name="columns">Texels of a row, 1 or more.</param>
        /// <param name="sizeMetres">Length of the whole map along its columns and its rows, above 0 m, where its
        /// objects have their usual size.</param>
        /// <param name="depthMetres">Range of the heights, above 0 m to 1 m.</param>
        /// <param name="tipRadiusMetres">Radius of the tip's ball, 0 to 0.05 m: it does not reach the bottom of a
        /// groove that is narrower.</param>
        /// <param name="isTiled">True if the map goes on at its rims with the opposite one; false if the rim's heights
        /// go on.</param>
        /// <exception cref="HaptoFlowException">A number is out of range, there are too many texels, or there is no
        /// library.</exception>
        public HapticReliefMap(ReadOnlySpan<float> heightsMetres, int columns, (float Columns, float Rows) sizeMetres,
            float depthMetres, float tipRadiusMetres, bool isTiled)
        {
            LibraryAgreement.Require();
            var options = new ReliefOptions
            {
                StructSize = (uint)sizeof(ReliefOptions),
                Columns = (uint)Math.Max(0, columns),
                Rows = (uint)RowsOf(heightsMetres.Length, columns),
                IsTiled = isTiled ? 1u : 0u,
                DepthMetres = depthMetres,
                TipRadiusMetres = tipRadiusMetres,
            };
            (options.SizeMetres[0], options.SizeMetres[1]) = sizeMetres;
            fixed (float* heights = heightsMetres)
            {
                options.HeightsMetres = heights;
                uint made;
                NativeCall.Check(NativeMethods.ReliefCreate(&options, &made));
                number = unchecked((int)made);
            }
        }

        /// <summary>Destroys a relief that was not disposed.</summary>
        ~HapticReliefMap() => Destroy();

        /// <summary>The library's number, for <see cref="ContactState.Relief"/>; 0 once it is disposed.</summary>
        public uint Number => unchecked((uint)Volatile.Read(ref number));

        /// <summary>Heights in metres whose slopes differ least from those of a normal map; the lowest is 0.</summary>
        /// <param name="normals">Three numbers for each texel, of any length: along the columns, along the rows, out of
        /// the surface.</param>
        /// <param name="columns">Texels of a row, 1 or more.</param>
        /// <param name="sizeMetres">Length of the whole map along its columns and its rows.</param>
        /// <param name="isTiled">False to mirror the map at its rims.</param>
        /// <exception cref="HaptoFlowException">A number is out of range, there are too many texels, or there is no
        /// library.</exception>
        public static float[] HeightsOfNormals(
            ReadOnlySpan<float> normals, int columns, (float Columns, float Rows) sizeMetres, bool isTiled)
        {
            LibraryAgreement.Require();
            int rows = RowsOf(normals.Length / 3, columns);
            var heights = new float[Math.Max(0, columns) * rows];
            float* size = stackalloc float[] { sizeMetres.Columns, sizeMetres.Rows };
            fixed (float* from = normals)
            fixed (float* into = heights)
            {
                NativeCall.Check(NativeMethods.ReliefHeightsOfNormals(
                    from, (uint)Math.Max(0, columns), (uint)rows, size, isTiled ? 1u : 0u, into));
            }
            return heights;
        }

        /// <summary>Destroys the relief. A voice that plays it goes on until its next contact state.</summary>
        public void Dispose()
        {
            Destroy();
            GC.SuppressFinalize(this);
        }

        private static int RowsOf(int texels, int columns) => columns > 0 ? texels / columns : 0;

        private void Destroy()
        {
            uint destroying = unchecked((uint)Interlocked.Exchange(ref number, 0));
            if (destroying != 0)
            {
                NativeMethods.ReliefDestroy(&destroying);
            }
        }
    }

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
