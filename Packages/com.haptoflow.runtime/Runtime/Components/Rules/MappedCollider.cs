#nullable enable
using System;
using System.Collections.Generic;
using UnityEngine;

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
}
