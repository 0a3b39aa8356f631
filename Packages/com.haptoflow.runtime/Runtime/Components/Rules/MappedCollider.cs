#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Numerics;
using UnityEngine;
using UnityEngine.SceneManagement;

namespace HaptoFlow
{
    /// <summary>The materials that the rules of maps assign to a collider: to the whole, or to each part. Main thread.
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

        /// <summary>Version of the maps that were matched.</summary>
        public int MapsVersion { get; set; }

        /// <summary>True where at least one part has a material.</summary>
        public bool CanBeFelt { get; private set; }

        /// <summary>Submeshes or terrain layers in their order; one entry for other colliders.</summary>
        public IReadOnlyList<MappedPart> Parts => parts;

        /// <summary>True where the same rule matches all parts.</summary>
        public bool IsUniform { get; private set; }

        public ColliderFacts Facts { get; private set; }

        /// <summary>True where no property that rules can match has changed.</summary>
        public bool IsUpToDate() => Facts.AreUnchanged();

        /// <summary>Matches the rules again.</summary>
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

        /// <summary>Names the rule that assigns a part's material. Makes garbage.</summary>
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
            if (found.Mask is { } mask &&
                mask.TryFeel(place, found.Material, session, Collider, out ResolvedMaterial masked))
            {
                masked.Part = part;
                return masked;
            }
            if (found.Material is null)
            {
                return default;
            }
            ResolvedMaterial felt = ResolvedMaterial.Of(found.Material.Description, found.Material.LookUp(session, Collider));
            felt.Part = part;
            return felt;
        }

        private ResolvedMaterial OnTerrain(TerrainData terrain, in TouchedPlace place, HapticSession session)
        {
            float[] weights = TerrainWeights.Of((TerrainCollider)Collider, terrain).At(place.LocalMetres, terrain.size.ToDouble());
            MaterialMix mix = MaterialMix.Shared;
            mix.Begin();
            for (int layer = 0; layer < parts.Length && layer < weights.Length; ++layer)
            {
                if (parts[layer].Material is { } material)
                {
                    mix.Add(material, session, Collider, weights[layer], layer);
                }
                else
                {
                    mix.AddNothing(weights[layer]);
                }
            }
            return mix.Finish();
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
        public MappedPart(HapticMaterialMap? map, int rule, HapticMaterial? material, HapticMaskMap? mask)
        {
            Map = map;
            Rule = rule;
            Material = material != null ? material : null;
            Mask = mask != null ? mask : null;
        }

        /// <summary>Null where no map matches.</summary>
        public HapticMaterialMap? Map { get; }

        public int Rule { get; }

        /// <summary>Null where the rule assigns none.</summary>
        public HapticMaterial? Material { get; }

        public HapticMaskMap? Mask { get; }

        public bool CanBeFelt => Material is object || (Mask is object && Mask.NamesMaterials);

        public bool IsSameAs(in MappedPart other) => ReferenceEquals(Map, other.Map) && Rule == other.Rule;

        /// <summary>Names the rule, for people. Makes garbage.</summary>
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

    /// <summary>Caches the materials that the maps assign to colliders without a surface. Main thread; no garbage for a
    /// known collider that has not changed.</summary>
    internal static class MappedColliders
    {
        private static readonly ObjectCache<Collider, MappedCollider> Known = new ObjectCache<Collider, MappedCollider>();
        private static readonly List<HapticMaterialMap> Maps = new List<HapticMaterialMap>();

        /// <summary>Number of cached colliders.</summary>
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
        private static void Forget()
        {
            Known.Clear();
            SceneManager.sceneUnloaded -= OnSceneUnloaded;
            SceneManager.sceneUnloaded += OnSceneUnloaded;
        }

        private static void OnSceneUnloaded(Scene scene) => Known.Sweep();
    }
}
