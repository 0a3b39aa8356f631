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
    /// <summary>The properties of a collider that rules can match, read once. Main thread. Reading makes garbage;
    /// checking whether they have changed makes none.</summary>
    internal sealed class ColliderFacts
    {
        private const string CopySuffix = " (Instance)";
        private static readonly List<Material> RendererMaterials = new List<Material>();

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

        /// <summary>Number of submeshes of a mesh collider or of layers of a terrain; 1 for other colliders.</summary>
        public int Parts { get; } = 1;

        /// <summary>The renderer's material of a submesh; the first for colliders that are not meshes.</summary>
        public Material? RendererMaterialOf(int part) =>
            part < rendererMaterials.Length ? rendererMaterials[part] : null;

        public TerrainLayer? TerrainLayerOf(int part) => part < terrainLayers.Length ? terrainLayers[part] : null;

        /// <summary>True where no property that rules can match has changed. Names and a terrain's layers are not
        /// compared: reading them makes garbage.</summary>
        public bool AreUnchanged()
        {
            GameObject owner = collider.gameObject;
            // Compare references: after its destruction an object equals the null that Unity returns for it.
            return owner.layer == Layer && owner.CompareTag(Tag) &&
                ReferenceEquals(collider.sharedMaterial, PhysicsMaterial) &&
                (!(collider is MeshCollider mesh) || ReferenceEquals(mesh.sharedMesh, Mesh)) &&
                (!(collider is TerrainCollider terrain) || ReferenceEquals(terrain.terrainData, Terrain)) &&
                HasSameMaterials();
        }

        /// <summary>True for the asset itself and for the instance that Unity creates when a script requests an
        /// object's own material.</summary>
        public static bool IsSameOrCopy(Object? asset, Object? found)
        {
            if (asset == null || found == null)
            {
                return false;
            }
            return found == asset || found.name == asset.name + CopySuffix;
        }

        /// <summary>The renderer of a mesh or a skinned mesh: on the collider's object, else on the nearest object
        /// above it, else below it.</summary>
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

        private bool HasSameMaterials()
        {
            if (renderer is null)
            {
                return true;
            }
            if (renderer == null)
            {
                return false;
            }
            renderer.GetSharedMaterials(RendererMaterials);
            bool same = RendererMaterials.Count == rendererMaterials.Length;
            for (int index = 0; same && index < rendererMaterials.Length; ++index)
            {
                same = ReferenceEquals(RendererMaterials[index], rendererMaterials[index]);
            }
            RendererMaterials.Clear();
            return same;
        }
    }
}
