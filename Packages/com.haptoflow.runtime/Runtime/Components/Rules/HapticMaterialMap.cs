#nullable enable
using System;
using System.Collections.Generic;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Says by rules which object is which material, so that a scene needs no tagging by hand. The first rule
    /// that matches counts; a <see cref="HapticSurface"/> on an object wins over every rule.</summary>
    /// <remarks>A project's map is chosen in <see cref="HaptoFlowSettings"/>, further ones for a scene by a
    /// <see cref="HapticMaterialMapScope"/>. What a collider feels like is worked out when a tip comes near, and again
    /// when its tag, layer, materials or mesh change, or any map does. A new name, and layers added to a terrain, are
    /// noticed after <see cref="Refresh"/>. Main thread.</remarks>
    [CreateAssetMenu(menuName = "HaptoFlow/Haptic Material Map", fileName = "HapticMaterialMap", order = 3)]
    [HelpURL(HelpPages.Components + "haptic-material-map")]
    public sealed class HapticMaterialMap : ScriptableObject
    {
        [SerializeField, Tooltip("The first rule that matches counts.")]
        private List<HapticMaterialRule> rules = new List<HapticMaterialRule>();

        [SerializeField, Tooltip("What no rule matches feels like this; empty to ask the next map, and to feel " +
            "nothing where there is none.")]
        private HapticMaterial? defaultMaterial;

        /// <summary>In their order: the first that matches counts.</summary>
        public IReadOnlyList<HapticMaterialRule> Rules => rules;

        /// <summary>What no rule matches; null to ask the next map, and to feel nothing where there is none.</summary>
        public HapticMaterial? DefaultMaterial
        {
            get => defaultMaterial;
            set
            {
                defaultMaterial = value;
                MaterialMaps.Change();
            }
        }

        /// <summary>Adds a rule behind all others.</summary>
        public void Add(HapticMaterialRule rule) => Insert(rules.Count, rule);

        /// <param name="index">0 for before all others.</param>
        public void Insert(int index, HapticMaterialRule rule)
        {
            rules.Insert(index, rule ?? throw new ArgumentNullException(nameof(rule)));
            MaterialMaps.Change();
        }

        /// <summary>Takes a rule away, by its place.</summary>
        public void RemoveAt(int index)
        {
            rules.RemoveAt(index);
            MaterialMaps.Change();
        }

        /// <summary>Takes all rules away.</summary>
        public void Clear()
        {
            rules.Clear();
            MaterialMaps.Change();
        }

        /// <summary>Works out anew what every collider feels like, by all maps: after objects were renamed, and after
        /// the layers of a terrain changed at run time.</summary>
        public static void Refresh()
        {
            TerrainWeights.Forget();
            MaterialMaps.Change();
        }

        /// <summary>For people: <c>rule 3 of "Rooms": tag "Floor"</c>.</summary>
        /// <param name="rule">Below 0 for the default.</param>
        internal string Explain(int rule) => rule < 0 || rule >= rules.Count
            ? $"default of \"{name}\""
            : $"rule {rule + 1} of \"{name}\": {rules[rule].Describe()}";

        /// <summary>The first rule that matches a part of a collider; false where none does and there is no default.
        /// </summary>
        internal bool TryMatch(ColliderFacts facts, int part, out FeltPart found)
        {
            for (int index = 0; index < rules.Count; ++index)
            {
                HapticMaterialRule rule = rules[index];
                if (rule.Matches(facts, part))
                {
                    found = new FeltPart(this, index, rule.Material, rule.Mask);
                    return true;
                }
            }
            found = new FeltPart(this, -1, defaultMaterial, null);
            return defaultMaterial != null;
        }

        private void OnEnable() => MaterialMaps.Change();

        private void OnDisable() => MaterialMaps.Change();

        private void OnValidate() => MaterialMaps.Change();
    }
}
