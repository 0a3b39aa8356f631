#nullable enable
using System;
using System.Collections.Generic;
using UnityEngine;
using Object = UnityEngine.Object;
#if UNITY_6000_0_OR_NEWER
using SurfacePhysics = UnityEngine.PhysicsMaterial;
#else
using SurfacePhysics = UnityEngine.PhysicMaterial;
#endif

namespace HaptoFlow
{
    /// <summary>What rules may ask of a collider, read once. Main thread. Reading makes garbage; asking whether it
    /// still holds makes none.</summary>
    internal sealed class ColliderFacts
    {
        private const string CopySuffix = " (Instance)";
        private static readonly List<Material> Shown = new List<Material>();

        private readonly Collider collider;
        private readonly Renderer? renderer;
        private readonly Material[] rendererMaterials = Array.Empty<Material>();
        private readonly TerrainLayer[] terrainLayers = Array.Empty<TerrainLayer>();

        public ColliderFacts(Collider collider)
        {
            this.collider = collider;
            GameObject owner = collider.gameObject;
            Name = owner.name;
            Tag = owner.tag;
            Layer = owner.layer;
            PhysicsMaterial = collider.sharedMaterial;
            renderer = RendererOf(collider);
            if (renderer != null)
            {
                rendererMaterials = renderer.sharedMaterials;
            }
            if (collider is MeshCollider mesh)
            {
                Mesh = mesh.sharedMesh;
                Parts = Mesh != null ? Math.Max(1, Mesh.subMeshCount) : 1;
            }
            if (collider is TerrainCollider terrain)
            {
                Terrain = terrain.terrainData;
                terrainLayers = Terrain != null ? Terrain.terrainLayers : terrainLayers;
                Parts = Math.Max(1, terrainLayers.Length);
            }
        }

        public string Name { get; }

        public string Tag { get; }

        public int Layer { get; }

        public SurfacePhysics? PhysicsMaterial { get; }

        /// <summary>Null for other than mesh colliders.</summary>
        public Mesh? Mesh { get; }

        /// <summary>Null for other than terrain colliders.</summary>
        public TerrainData? Terrain { get; }

        /// <summary>Submeshes of a mesh collider, layers of a terrain; 1 for anything else.</summary>
        public int Parts { get; } = 1;

        /// <summary>How many materials the object's renderer has; 0 without a renderer.</summary>
        public int RendererMaterialCount => rendererMaterials.Length;

        /// <summary>The renderer's material of a submesh; the first for colliders that are no meshes.</summary>
        public Material? RendererMaterialOf(int part) =>
            part < rendererMaterials.Length ? rendererMaterials[part] : null;

        public TerrainLayer? TerrainLayerOf(int part) => part < terrainLayers.Length ? terrainLayers[part] : null;

        /// <summary>Nothing has changed that a rule may ask for, but for names and a terrain's layers: reading those
        /// makes garbage.</summary>
        public bool Hold()
        {
            GameObject owner = collider.gameObject;
            // By reference: what was destroyed meanwhile equals the null that Unity gives out for it.
            return owner.layer == Layer && owner.CompareTag(Tag) &&
                ReferenceEquals(collider.sharedMaterial, PhysicsMaterial) &&
                (!(collider is MeshCollider mesh) || ReferenceEquals(mesh.sharedMesh, Mesh)) &&
                (!(collider is TerrainCollider terrain) || ReferenceEquals(terrain.terrainData, Terrain)) &&
                ShowsTheSame();
        }

        /// <summary>The asset itself, or the copy that Unity makes of it when a script asks for an object's own.
        /// </summary>
        public static bool IsSameOrCopy(Object? asset, Object? found)
        {
            if (asset == null || found == null)
            {
                return false;
            }
            return found == asset || found.name == asset.name + CopySuffix;
        }

        /// <summary>Of a mesh or a skinned mesh: on the collider's object, else on the nearest object above it, else
        /// below it.</summary>
        private static Renderer? RendererOf(Collider collider)
        {
            for (Transform? place = collider.transform; place != null; place = place.parent)
            {
                if (place.TryGetComponent(out MeshRenderer mesh))
                {
                    return mesh;
                }
                if (place.TryGetComponent(out SkinnedMeshRenderer skinned))
                {
                    return skinned;
                }
            }
            Renderer? below = collider.GetComponentInChildren<MeshRenderer>(true);
            return below != null ? below : collider.GetComponentInChildren<SkinnedMeshRenderer>(true);
        }

        private bool ShowsTheSame()
        {
            if (renderer is null)
            {
                return true;
            }
            if (renderer == null)
            {
                return false;
            }
            renderer.GetSharedMaterials(Shown);
            bool same = Shown.Count == rendererMaterials.Length;
            for (int index = 0; same && index < rendererMaterials.Length; ++index)
            {
                same = ReferenceEquals(Shown[index], rendererMaterials[index]);
            }
            Shown.Clear();
            return same;
        }
    }
}
