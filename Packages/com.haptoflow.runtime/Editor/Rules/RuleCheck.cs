#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEditorInternal;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Rules that can never match, and why.</summary>
    internal static class RuleCheck
    {
        /// <summary>Null for a rule that can match something.</summary>
        public static string? ProblemOf(HapticMaterialMap map, int index)
        {
            HapticMaterialRule rule = map.Rules[index];
            if (!rule.IsComplete)
            {
                return "names nothing to look for";
            }
            if (rule.Subject == MaterialRuleSubject.Tag && !InternalEditorUtility.tags.Contains(rule.Tag))
            {
                return "looks for a tag that the project does not have";
            }
            if (rule.Subject == MaterialRuleSubject.Layer && LayerMask.LayerToName(rule.Layer).Length == 0)
            {
                return "looks for a layer that the project gives no name";
            }
            if (rule.Subject == MaterialRuleSubject.Submesh && rule.Mesh != null &&
                rule.Submesh >= rule.Mesh.subMeshCount)
            {
                return $"looks for submesh {rule.Submesh} of a mesh whose last is {rule.Mesh.subMeshCount - 1}";
            }
            for (int before = 0; before < index; ++before)
            {
                if (Covers(map.Rules[before], rule))
                {
                    return $"never matches: rule {before + 1} ({map.Rules[before].Describe()}) comes first and takes " +
                        "everything that it would match";
                }
            }
            return null;
        }

        /// <summary>Everything that the second matches is matched by the first.</summary>
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
            switch (first.Subject)
            {
                case MaterialRuleSubject.Tag:
                    return first.Tag == second.Tag;
                case MaterialRuleSubject.Layer:
                    return first.Layer == second.Layer;
                case MaterialRuleSubject.PhysicsMaterial:
                    return first.PhysicsMaterial == second.PhysicsMaterial;
                case MaterialRuleSubject.RendererMaterial:
                    return first.RendererMaterial == second.RendererMaterial;
                case MaterialRuleSubject.TerrainLayer:
                    return first.TerrainLayer == second.TerrainLayer;
                case MaterialRuleSubject.Submesh:
                    return first.Submesh == second.Submesh && (first.Mesh == null || first.Mesh == second.Mesh);
                default:
                    // A star of the second is a character that only a star of the first takes.
                    return NamePattern.Matches(first.NamePattern, second.NamePattern);
            }
        }
    }
}
