#nullable enable
using System;
using System.Collections.Generic;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Assigns materials to objects by rules, so that a scene needs no tagging by hand. The first rule that
    /// matches applies; a <see cref="HapticSurface"/> on an object takes precedence over every rule.</summary>
    /// <remarks>A project's map is chosen in <see cref="HaptoFlowSettings"/>, further ones for a scene with a <see
    /// cref="HapticMaterialMapScope"/>. The rules are matched when a tip comes near a collider, and again when the
    /// collider's tag, layer, materials or mesh change, or any map changes. After renaming an object, or adding layers
    /// to a terrain, call <see cref="Refresh"/>. Main thread.</remarks>
    [CreateAssetMenu(menuName = "HaptoFlow/Haptic Material Map", fileName = "HapticMaterialMap", order = 3)]
    [HelpPage(HelpPages.Components + "haptic-material-map")]
    public sealed class HapticMaterialMap : ScriptableObject
    {
        [SerializeField, Tooltip("The first rule that matches assigns the material. A Haptic Surface on an object " +
            "takes precedence over every rule.")]
        private List<HapticMaterialRule> rules = new List<HapticMaterialRule>();

        [SerializeField, Tooltip("Objects that no rule matches have the default material. When it is empty, the next " +
            "map decides, or they are not felt.")]
        private HapticMaterial? defaultMaterial;

        /// <summary>The rules in order: the first that matches applies.</summary>
        public IReadOnlyList<HapticMaterialRule> Rules => rules;

        /// <summary>The material where no rule matches; null to try the next map, without which there is no
        /// material.</summary>
        public HapticMaterial? DefaultMaterial { get => defaultMaterial; set => MaterialMaps.Set(ref defaultMaterial, value); }

        /// <summary>Adds a rule after all others.</summary>
        public void Add(HapticMaterialRule rule) => Insert(rules.Count, rule);

        /// <param name="index">Position of the rule; 0 for the first.</param>
        public void Insert(int index, HapticMaterialRule rule)
        {
            rules.Insert(index, rule ?? throw new ArgumentNullException(nameof(rule)));
            MaterialMaps.Change();
        }

        /// <summary>Removes the rule at a position.</summary>
        public void RemoveAt(int index)
        {
            rules.RemoveAt(index);
            MaterialMaps.Change();
        }

        /// <summary>Removes all rules.</summary>
        public void Clear()
        {
            rules.Clear();
            MaterialMaps.Change();
        }

        /// <summary>Matches all maps again with every collider. Call it after renaming objects, and after the layers of
        /// a terrain changed at run time.</summary>
        public static void Refresh()
        {
            TerrainWeights.Forget();
            MaterialMaps.Change();
        }

        /// <summary>Names a rule for people: <c>rule 3 of "Rooms": tag "Floor"</c>.</summary>
        /// <param name="rule">Index of the rule; below 0 for the default.</param>
        internal string Explain(int rule) => rule < 0 || rule >= rules.Count
            ? $"default of \"{name}\""
            : $"rule {rule + 1} of \"{name}\": {rules[rule].Describe()}";

        /// <summary>Finds the first rule that matches a part of a collider; false where none does and there is no
        /// default.</summary>
        internal bool TryMatch(ColliderFacts facts, int part, out MappedPart found)
        {
            for (int index = 0; index < rules.Count; ++index)
            {
                HapticMaterialRule rule = rules[index];
                if (rule.Matches(facts, part))
                {
                    found = new MappedPart(this, index, rule.Material, rule.Mask, rule.Relief);
                    return true;
                }
            }
            found = new MappedPart(this, -1, defaultMaterial, null);
            return defaultMaterial != null;
        }

        private void OnEnable() => MaterialMaps.Change();

        private void OnDisable() => MaterialMaps.Change();

        private void OnValidate() => MaterialMaps.Change();
    }
}
