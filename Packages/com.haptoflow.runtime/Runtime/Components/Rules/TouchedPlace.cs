#nullable enable
using HaptoFlow.Numerics;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>A place on a collider with the data that materials can vary by.</summary>
    internal readonly struct TouchedPlace
    {
        private readonly Collider collider;
        private readonly RaycastHit hit;
        private readonly bool hasTriangle;

        /// <param name="hit">The ray hit that found the place; null where no ray was needed.</param>
        public TouchedPlace(Collider collider, Double3 localMetres, in RaycastHit? hit)
        {
            this.collider = collider;
            LocalMetres = localMetres;
            this.hit = hit ?? default;
            hasTriangle = hit.HasValue && collider is MeshCollider mesh && !mesh.convex;
        }

        /// <summary>Position relative to the collider's origin, in its local axes, in metres.</summary>
        public Double3 LocalMetres { get; }

        /// <summary>Triangle index; below 0 where the physics engine provides none: everything but non-convex
        /// meshes.</summary>
        public int Triangle => hasTriangle ? hit.triangleIndex : -1;

        /// <summary>False where the physics engine provides no coordinate: everything but readable, non-convex
        /// meshes.</summary>
        /// <param name="second">True for the mesh's second texture coordinates.</param>
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
