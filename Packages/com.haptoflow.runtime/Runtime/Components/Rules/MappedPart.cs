#nullable enable

namespace HaptoFlow
{
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
}
