#nullable enable
using System;

namespace HaptoFlow.Outputs
{
    /// <summary>Arrays for calls that take whole arrays: one per length, created at its first use and reused
    /// afterwards.</summary>
    public sealed class ArraysByLength<T>
    {
        private T[]?[] arrays = new T[]?[16];

        /// <summary>The array of a length; the same object each time.</summary>
        public T[] Of(int length)
        {
            if (arrays.Length <= length)
            {
                Array.Resize(ref arrays, 2 * length);
            }
            return arrays[length] ??= new T[length];
        }
    }
}
