#nullable enable
using HaptoFlow.Numerics;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>A place on a collider, as far as materials may differ from place to place.</summary>
    internal readonly struct TouchedPlace
    {
        private readonly Collider collider;
        private readonly RaycastHit hit;
        private readonly bool hasTriangle;

        /// <param name="hit">Of the ray that found the place; null where no ray did.</param>
        public TouchedPlace(Collider collider, Double3 localMetres, in RaycastHit? hit)
        {
            this.collider = collider;
            LocalMetres = localMetres;
            this.hit = hit ?? default;
            hasTriangle = hit.HasValue && collider is MeshCollider mesh && !mesh.convex;
        }

        /// <summary>From the collider's origin, in its local axes, in metres.</summary>
        public Double3 LocalMetres { get; }

        /// <summary>Below 0 where the physics engine says none: all but meshes that are not convex.</summary>
        public int Triangle => hasTriangle ? hit.triangleIndex : -1;

        /// <summary>False where the physics engine says none: all but readable meshes that are not convex.</summary>
        /// <param name="second">The mesh's second set.</param>
        public bool TryGetTextureCoordinate(bool second, out Vector2 coordinate)
        {
            coordinate = default;
            if (!hasTriangle || !(((MeshCollider)collider).sharedMesh is { } mesh) || !mesh.isReadable)
            {
                return false;
            }
            coordinate = second ? hit.textureCoord2 : hit.textureCoord;
            return !float.IsNaN(coordinate.x + coordinate.y) && !float.IsInfinity(coordinate.x + coordinate.y);
        }
    }
}
