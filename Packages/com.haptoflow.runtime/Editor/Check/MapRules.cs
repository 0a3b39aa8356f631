#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEditorInternal;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>Lists what each collider feels like and by which rule. Finds rules that can never match, and submeshes
    /// and masks that have no effect.</summary>
    internal static class MapRules
    {
        public static IEnumerable<Finding> Check(SceneContents scene) => scene.Maps.All
            .SelectMany(CheckMap)
            .Concat(CheckMasks(scene))
            .Concat(CheckMeshes(scene))
            .Concat(ListColliders(scene));

        private static IEnumerable<Finding> CheckMap(HapticMaterialMap map)
        {
            for (int index = 0; index < map.Rules.Count; ++index)
            {
                int place = index;
                string? problem = RuleCheck.ProblemOf(map, index);
                if (problem != null)
                {
                    yield return new Finding(MessageType.Warning, $"Rule {index + 1} of {map.name} {problem}.",
                        new[] { map }, new Repair("Remove the Rule", () => Remove(map, place)));
                }
                foreach (Finding finding in CheckMaterial(map.Rules[index].Material))
                {
                    yield return finding;
                }
            }
            foreach (Finding finding in CheckMaterial(map.DefaultMaterial))
            {
                yield return finding;
            }
            if (map.Rules.Count == 0 && map.DefaultMaterial == null)
            {
                yield return new Finding(MessageType.Info, $"The map {map.name} has no rule and no default.",
                    new[] { map });
            }
        }

        private static IEnumerable<Finding> CheckMaterial(HapticMaterial? material) => material == null
            ? Enumerable.Empty<Finding>()
            : SurfaceRules.CheckLabels(LabelCatalog.Current, material, material.Description, "description.");

        private static IEnumerable<Finding> CheckMasks(SceneContents scene)
        {
            foreach (IGrouping<HapticMaskMap, Collider> mask in scene.Answers
                .SelectMany(answer => MasksOf(answer).Select(mask => (mask, answer.Collider)))
                .GroupBy(each => each.mask, each => each.Collider))
            {
                string? problem = MaskBake.ProblemOf(mask.Key);
                if (problem != null)
                {
                    yield return new Finding(MessageType.Warning, problem, new[] { mask.Key },
                        MaskBake.RepairsOf(mask.Key).ToArray());
                }
                Collider[] unmasked = mask
                    .Where(collider => WhyNoCoordinates(collider, mask.Key.SecondCoordinates) != null).ToArray();
                foreach (IGrouping<string, Collider> reason in unmasked.GroupBy(
                    collider => WhyNoCoordinates(collider, mask.Key.SecondCoordinates)!))
                {
                    yield return new Finding(MessageType.Warning,
                        $"{MaterialWords.Names(reason.ToArray())}: the mask {mask.Key.name} has no effect, " +
                        $"because {reason.Key}.", Owners(reason));
                }
            }
        }

        private static IEnumerable<HapticMaskMap> MasksOf(ColliderMaterial answer)
        {
            if (answer.Surface is object)
            {
                return answer.Surface.Mask != null ? new[] { answer.Surface.Mask } : new HapticMaskMap[0];
            }
            return answer.ByRules.Parts.Where(part => part.Mask is object).Select(part => part.Mask!).Distinct();
        }

        /// <summary>Why a hit has no texture coordinates; null when it has them.</summary>
        internal static string? WhyNoCoordinates(Collider collider, bool second)
        {
            if (!(collider is MeshCollider mesh))
            {
                return "only a mesh collider has texture coordinates where it is touched";
            }
            if (mesh.convex)
            {
                return "a convex mesh collider has no texture coordinates: switch Convex off";
            }
            if (mesh.sharedMesh == null)
            {
                return "the collider has no mesh";
            }
            if (!mesh.sharedMesh.isReadable)
            {
                return "its mesh is not readable: switch on Read/Write in the model's import settings";
            }
            bool lacksSet = second ? mesh.sharedMesh.uv2.Length == 0 : mesh.sharedMesh.uv.Length == 0;
            return lacksSet
                ? $"its mesh has no {(second ? "second" : "first")} texture coordinates"
                : null;
        }

        /// <summary>Submeshes with different materials can be told apart only by the touched triangle.</summary>
        private static IEnumerable<Finding> CheckMeshes(SceneContents scene)
        {
            ColliderMaterial[] several = scene.Answers
                .Where(answer => answer.Surface is null && !answer.ByRules.IsUniform && answer.Collider is MeshCollider)
                .ToArray();
            Collider[] unreadable = several.Select(answer => answer.Collider)
                .Where(collider => !((MeshCollider)collider).sharedMesh!.isReadable).ToArray();
            if (unreadable.Length > 0)
            {
                yield return new Finding(MessageType.Warning,
                    $"{MaterialWords.Names(unreadable)}: the submeshes feel like different materials, but the " +
                    "mesh is not readable, so all of it feels like the first. Switch on Read/Write in the model's " +
                    "import settings.", Owners(unreadable),
                    Readability.RepairsOf(unreadable.Select(each => ((MeshCollider)each).sharedMesh!)).ToArray());
            }
            Collider[] convex = several.Select(answer => answer.Collider)
                .Where(collider => ((MeshCollider)collider).convex).ToArray();
            if (convex.Length > 0)
            {
                yield return new Finding(MessageType.Warning,
                    $"{MaterialWords.Names(convex)}: the submeshes feel like different materials, but a convex collider " +
                    "does not report which triangle is touched, so all of it feels like the first. Switch Convex " +
                    "off, or give each material a collider of its own.", Owners(convex));
            }
        }

        /// <summary>Lists the colliders, with one finding for all that feel the same for the same reason.</summary>
        private static IEnumerable<Finding> ListColliders(SceneContents scene)
        {
            if (scene.Maps.All.Count == 0)
            {
                yield break;
            }
            foreach (IGrouping<string, ColliderMaterial> same in scene.Answers
                .GroupBy(answer => answer.CanBeFelt
                    ? $"felt as {answer.Material} ({answer.Reason})"
                    : $"not felt ({answer.Reason})"))
            {
                Collider[] colliders = same.Select(answer => answer.Collider).ToArray();
                yield return new Finding(MessageType.Info,
                    $"{MaterialWords.Names(colliders)}: {same.Key}.", Owners(colliders));
            }
        }

        private static IReadOnlyList<Object> Owners(IEnumerable<Collider> colliders) =>
            colliders.Select(collider => (Object)collider.gameObject).Distinct().ToArray();

        private static void Remove(HapticMaterialMap map, int place)
        {
            Undo.RecordObject(map, "Remove the Rule");
            map.RemoveAt(place);
            EditorUtility.SetDirty(map);
        }
    }

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
