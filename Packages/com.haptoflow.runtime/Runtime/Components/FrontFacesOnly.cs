#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>While it lives, rays hit the fronts of meshes only: with Physics.queriesHitBackfaces, a hit back turns
    /// its normal around and feels like a front. The project's setting is put back at the end. Main thread, no garbage.
    /// </summary>
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
