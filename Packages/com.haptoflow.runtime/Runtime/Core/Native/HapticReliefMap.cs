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
            RequireLibrary();
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
            RequireLibrary();
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

        private static void RequireLibrary() => NativeCall.OrMissing(() =>
        {
            LibraryAgreement.Require();
            return true;
        });

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
}
