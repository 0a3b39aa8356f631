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
        /// <summary>Component along the frame's first axis.</summary>
        public readonly float X;

        /// <summary>Component along the frame's second axis.</summary>
        public readonly float Y;

        /// <summary>Component along the frame's third axis.</summary>
        public readonly float Z;

        /// <param name="x">Component along the frame's first axis.</param>
        /// <param name="y">Component along the frame's second axis.</param>
        /// <param name="z">Component along the frame's third axis.</param>
        public PlaceVector(float x, float y, float z) => (X, Y, Z) = (x, y, z);

        internal PlaceVector(Double3 vector) : this((float)vector.X, (float)vector.Y, (float)vector.Z)
        {
        }
    }
}
