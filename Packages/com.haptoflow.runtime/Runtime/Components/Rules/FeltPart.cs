#nullable enable

namespace HaptoFlow
{
    /// <summary>What one part of a collider feels like, and by which rule.</summary>
    internal readonly struct FeltPart
    {
        /// <param name="rule">Below 0 for the map's default.</param>
        public FeltPart(HapticMaterialMap? map, int rule, HapticMaterial? material, HapticMaskMap? mask)
        {
            Map = map;
            Rule = rule;
            Material = material != null ? material : null;
            Mask = mask != null ? mask : null;
        }

        /// <summary>Null where no map says anything.</summary>
        public HapticMaterialMap? Map { get; }

        public int Rule { get; }

        /// <summary>Null for nothing.</summary>
        public HapticMaterial? Material { get; }

        public HapticMaskMap? Mask { get; }

        public bool CanBeFelt => Material is object || (Mask is object && Mask.NamesMaterials);

        public bool IsSameAs(in FeltPart other) => ReferenceEquals(Map, other.Map) && Rule == other.Rule;

        /// <summary>For people. Makes garbage.</summary>
        public string Explain() =>
            Map is null ? "no rule matches" : Map != null ? Map.Explain(Rule) : "a map that is gone";
    }
}
