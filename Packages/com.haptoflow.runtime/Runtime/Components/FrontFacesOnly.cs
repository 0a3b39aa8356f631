#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Makes rays hit only the front faces of meshes while it exists. With Physics.queriesHitBackfaces a hit
    /// on a back face has an inverted normal and would count as a front. Dispose restores the project's setting. Main
    /// thread, no garbage.</summary>
    internal readonly struct FrontFacesOnly : IDisposable
    {
        private readonly bool hitBackFaces;

        private FrontFacesOnly(bool hitBackFaces) => this.hitBackFaces = hitBackFaces;

        public static FrontFacesOnly Begin()
        {
            bool before = Physics.queriesHitBackfaces;
            if (before)
            {
                Physics.queriesHitBackfaces = false;
            }
            return new FrontFacesOnly(before);
        }

        public void Dispose()
        {
            if (hitBackFaces)
            {
                Physics.queriesHitBackfaces = true;
            }
        }
    }
}
