#nullable enable
using System.Runtime.InteropServices;
using HaptoFlow.Native;
using HaptoFlow.Numerics;

namespace HaptoFlow
{
    /// <summary>A point or a direction in the frame of a surface, as <see cref="ContactState"/> passes it to the
    /// library.</summary>
    [Preserve, StructLayout(LayoutKind.Sequential)]
    public readonly struct PlaceVector
    {
        /// <summary>x coordinate in the surface's frame.</summary>
        public readonly float X;

        /// <summary>y coordinate in the surface's frame.</summary>
        public readonly float Y;

        /// <summary>z coordinate in the surface's frame.</summary>
        public readonly float Z;

        /// <param name="x">x coordinate in the surface's frame.</param>
        /// <param name="y">y coordinate in the surface's frame.</param>
        /// <param name="z">z coordinate in the surface's frame.</param>
        public PlaceVector(float x, float y, float z) => (X, Y, Z) = (x, y, z);

        internal PlaceVector(Double3 vector) : this((float)vector.X, (float)vector.Y, (float)vector.Z)
        {
        }
    }
}
