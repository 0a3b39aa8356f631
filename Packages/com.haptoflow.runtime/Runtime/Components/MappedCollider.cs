#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Numerics;
using UnityEngine;
using Object = UnityEngine.Object;
#if UNITY_6000_0_OR_NEWER
using SurfacePhysics = UnityEngine.PhysicsMaterial;
#else
using SurfacePhysics = UnityEngine.PhysicMaterial;
#endif

namespace HaptoFlow
{
    /// <summary>The materials that the rules of maps give a collider, as a whole or part by part. Where the layers
    /// of a terrain blend, the tip feels the relief of the layer with the largest weight. Main thread.
    /// Matching the rules makes garbage; looking up a place makes none.</summary>
    internal sealed class MappedCollider
    {
        private MappedPart[] parts;
        private int[] trianglesUpTo = Array.Empty<int>();

        public MappedCollider(Collider collider, IReadOnlyList<HapticMaterialMap> maps)
        {
            Collider = collider;
            Facts = new ColliderFacts(collider);
            parts = Array.Empty<MappedPart>();
            Match(maps);
        }

        public Collider Collider { get; }

        public int MapsVersion { get; set; }

        public bool CanBeFelt { get; private set; }

        /// <summary>Submeshes or terrain layers in their order; one entry for other colliders.</summary>
        public IReadOnlyList<MappedPart> Parts => parts;

        public bool IsUniform { get; private set; }

        public ColliderFacts Facts { get; private set; }

        public bool IsUpToDate() => Facts.AreUnchanged();

        public void Renew(IReadOnlyList<HapticMaterialMap> maps)
        {
            Facts = new ColliderFacts(Collider);
            Match(maps);
        }

        /// <summary>The material at a place; without labels where there is none.</summary>
        public ResolvedMaterial At(in TouchedPlace place, HapticSession session)
        {
            if (!IsUniform && Facts.Terrain is { } terrain)
            {
                return OnTerrain(terrain, place, session);
            }
            int part = IsUniform ? 0 : PartOf(place.Triangle);
            return OfPart(part, place, session);
        }

        public string Explain(int part) => parts[part < parts.Length ? part : 0].Explain();

        private void Match(IReadOnlyList<HapticMaterialMap> maps)
        {
            if (parts.Length != Facts.Parts)
            {
                parts = new MappedPart[Facts.Parts];
            }
            IsUniform = true;
            CanBeFelt = false;
            bool isSupportedKind = ColliderProbe.IsSupportedKind(Collider);
            for (int part = 0; part < parts.Length; ++part)
            {
                parts[part] = Match(maps, part);
                IsUniform &= parts[part].IsSameAs(parts[0]);
                CanBeFelt |= isSupportedKind && parts[part].CanBeFelt;
            }
            trianglesUpTo = IsUniform || Facts.Mesh is null || !Facts.Mesh.isReadable
                ? Array.Empty<int>()
                : TrianglesUpTo(Facts.Mesh);
        }

        private MappedPart Match(IReadOnlyList<HapticMaterialMap> maps, int part)
        {
            for (int index = 0; index < maps.Count; ++index)
            {
                if (maps[index].TryMatch(Facts, part, out MappedPart found))
                {
                    return found;
                }
            }
            return default;
        }

        private ResolvedMaterial OfPart(int part, in TouchedPlace place, HapticSession session)
        {
            MappedPart found = parts[part];
            ResolvedMaterial felt = ResolvedMaterial.Of(found.Material, session, Collider);
            if (found.Mask is { } mask && mask.TryFeel(place, felt, session, Collider, out ResolvedMaterial masked))
            {
                felt = masked;
            }
            felt.Part = part;
            felt.Relief = found.Relief;
            return felt;
        }

        private ResolvedMaterial OnTerrain(TerrainData terrain, in TouchedPlace place, HapticSession session)
        {
            float[] weights = TerrainWeights.Of((TerrainCollider)Collider, terrain).At(place.LocalMetres, terrain.size.ToDouble());
            MaterialMix mix = MaterialMix.Shared;
            mix.Begin();
            for (int layer = 0; layer < parts.Length && layer < weights.Length; ++layer)
            {
                mix.Add(parts[layer].Material, session, Collider, weights[layer], layer);
            }
            ResolvedMaterial mixed = mix.Finish();
            mixed.Relief = mixed.Labels.Count > 0 ? parts[mixed.Part].Relief : null;
            return mixed;
        }

        /// <summary>The first submesh where the triangle is unknown.</summary>
        private int PartOf(int triangle)
        {
            for (int part = 0; triangle >= 0 && part < trianglesUpTo.Length; ++part)
            {
                if (triangle < trianglesUpTo[part])
                {
                    return part;
                }
            }
            return 0;
        }

        private static int[] TrianglesUpTo(Mesh mesh)
        {
            var upTo = new int[mesh.subMeshCount];
            int triangles = 0;
            for (int part = 0; part < upTo.Length; ++part)
            {
                bool isTriangles = mesh.GetTopology(part) == MeshTopology.Triangles;
                triangles += isTriangles ? (int)(mesh.GetIndexCount(part) / 3) : 0;
                upTo[part] = triangles;
            }
            return upTo;
        }
    }

    /// <summary>The material of one part of a collider, and the rule that assigns it.</summary>
    internal readonly struct MappedPart
    {
        /// <param name="rule">Index of the rule; below 0 for the map's default.</param>
        public MappedPart(
            HapticMaterialMap? map, int rule, HapticMaterial? material, HapticMaskMap? mask,
            HapticRelief? relief = null)
        {
            Map = map;
            Rule = rule;
            Material = material != null ? material : null;
            Mask = mask != null ? mask : null;
            Relief = relief != null ? relief : null;
        }

        /// <summary>Null where no map matches.</summary>
        public HapticMaterialMap? Map { get; }

        public int Rule { get; }

        public HapticMaterial? Material { get; }

        public HapticMaskMap? Mask { get; }

        public HapticRelief? Relief { get; }

        public bool CanBeFelt => Material is object || (Mask is object && Mask.NamesMaterials);

        public bool IsSameAs(in MappedPart other) => ReferenceEquals(Map, other.Map) && Rule == other.Rule;

        public string Explain() =>
            Map is null ? "no rule matches" : Map != null ? Map.Explain(Rule) : "a deleted map";
    }

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

        /// <summary>The mesh of <see cref="Triangle"/>; false where there is no triangle, and where scripts cannot read
        /// the mesh.</summary>
        public bool TryGetMesh(out Mesh mesh)
        {
            mesh = (hasTriangle ? ((MeshCollider)collider).sharedMesh : null)!;
            return mesh is object && mesh.isReadable;
        }

        /// <summary>False where the physics engine provides no coordinate: everything but readable, non-convex
        /// meshes.</summary>
        public bool TryGetTextureCoordinate(bool second, out Vector2 coordinate)
        {
            coordinate = default;
            if (!TryGetMesh(out _))
            {
                return false;
            }
            coordinate = second ? hit.textureCoord2 : hit.textureCoord;
            return !float.IsNaN(coordinate.x + coordinate.y) && !float.IsInfinity(coordinate.x + coordinate.y);
        }
    }

    /// <summary>Caches the materials that the maps assign to colliders without a surface. Main thread; no garbage for a
    /// known collider that has not changed.</summary>
    internal static class MappedColliders
    {
        private static readonly ObjectCache<Collider, MappedCollider> Known = new ObjectCache<Collider, MappedCollider>();
        private static readonly List<HapticMaterialMap> Maps = new List<HapticMaterialMap>();

        public static int Count => Known.Count;

        /// <summary>Null where no rule assigns a material to the collider.</summary>
        public static MappedCollider? Resolve(Collider collider)
        {
            if (!MaterialMaps.Any)
            {
                return null;
            }
            if (!Known.TryGetValue(collider, out MappedCollider felt))
            {
                MaterialMaps.CollectFor(collider.gameObject.scene, Maps);
                felt = new MappedCollider(collider, Maps) { MapsVersion = MaterialMaps.Version };
                Known.Set(collider, felt);
            }
            else if (felt.MapsVersion != MaterialMaps.Version || !felt.IsUpToDate())
            {
                MaterialMaps.CollectFor(collider.gameObject.scene, Maps);
                felt.Renew(Maps);
                felt.MapsVersion = MaterialMaps.Version;
            }
            return felt.CanBeFelt ? felt : null;
        }

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Forget() => Known.Begin();
    }

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

        public Mesh? Mesh { get; }

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
        internal static Renderer? RendererOf(Collider collider)
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
