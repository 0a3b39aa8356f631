#nullable enable
using System.Linq;
using UnityEditorInternal;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Finds rules that can never match.</summary>
    internal static class RuleCheck
    {
        /// <summary>Why a rule can never match, as the end of a sentence; null for a rule that can match.</summary>
        public static string? ProblemOf(HapticMaterialMap map, int index)
        {
            HapticMaterialRule rule = map.Rules[index];
            if (!rule.IsComplete)
            {
                return "has an empty condition";
            }
            if (rule.Subject == MaterialRuleSubject.Tag && !InternalEditorUtility.tags.Contains(rule.Tag))
            {
                return "matches a tag that the project does not have";
            }
            if (rule.Subject == MaterialRuleSubject.Layer && LayerMask.LayerToName(rule.Layer).Length == 0)
            {
                return "matches a layer that has no name in the project";
            }
            if (rule.Subject == MaterialRuleSubject.Submesh && rule.Mesh != null &&
                rule.Submesh >= rule.Mesh.subMeshCount)
            {
                return $"matches submesh {rule.Submesh} of a mesh whose last submesh is {rule.Mesh.subMeshCount - 1}";
            }
            for (int before = 0; before < index; ++before)
            {
                if (Covers(map.Rules[before], rule))
                {
                    return $"never matches: rule {before + 1} ({map.Rules[before].Describe()}) comes first and " +
                        "matches everything that it would match";
                }
            }
            return null;
        }

        /// <summary>Whether the first rule matches everything that the second matches.</summary>
        private static bool Covers(HapticMaterialRule first, HapticMaterialRule second)
        {
            if (!first.IsComplete)
            {
                return false;
            }
            if (first.Subject == MaterialRuleSubject.Name && first.NamePattern.Trim('*').Length == 0)
            {
                return true;
            }
            if (first.Subject != second.Subject)
            {
                return false;
            }
            return first.Subject switch
            {
                MaterialRuleSubject.Tag => first.Tag == second.Tag,
                MaterialRuleSubject.Layer => first.Layer == second.Layer,
                MaterialRuleSubject.PhysicsMaterial => first.PhysicsMaterial == second.PhysicsMaterial,
                MaterialRuleSubject.RendererMaterial => first.RendererMaterial == second.RendererMaterial,
                MaterialRuleSubject.TerrainLayer => first.TerrainLayer == second.TerrainLayer,
                MaterialRuleSubject.Submesh =>
                    first.Submesh == second.Submesh && (first.Mesh == null || first.Mesh == second.Mesh),
                // A * in the second pattern is treated as a character, which only a * in the first one matches.
                _ => NamePattern.Matches(first.NamePattern, second.NamePattern),
            };
        }
    }
}
