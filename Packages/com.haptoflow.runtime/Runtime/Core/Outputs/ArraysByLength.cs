#nullable enable
using System;

namespace HaptoFlow.Outputs
{
    /// <summary>Arrays for calls that take whole arrays: one for each length that ever occurs, so that no call makes
    /// garbage after the first of its length.</summary>
    public sealed class ArraysByLength<T>
    {
        private T[]?[] arrays = new T[]?[16];

        /// <summary>The array of that length; it is the same each time.</summary>
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
