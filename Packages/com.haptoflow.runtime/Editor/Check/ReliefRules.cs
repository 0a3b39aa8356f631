#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>Finds reliefs that cannot be felt, and why.</summary>
    internal static class ReliefRules
    {
        // At 0.3 m/s a tip crosses 60 such texels a second, the rhythm of a coarse rib.
        private const float CoarseTexelMillimetres = 5f;

        /// <summary>The colliders on which a surface or a rule has a relief.</summary>
        public static IEnumerable<(HapticRelief Relief, Collider Collider)> Uses(SceneContents scene) =>
            scene.Answers.SelectMany(answer => ReliefsOf(answer).Select(relief => (relief, answer.Collider)));

        public static IEnumerable<Finding> Check(SceneContents scene) => CheckUses(scene).Concat(CheckLayers(scene));

        private static IEnumerable<Finding> CheckUses(SceneContents scene)
        {
            foreach (IGrouping<HapticRelief, Collider> uses in Uses(scene)
                .GroupBy(use => use.Relief, use => use.Collider))
            {
                string? problem = ProblemOf(uses.Key);
                if (problem != null)
                {
                    yield return new Finding(MessageType.Warning, problem, new[] { uses.Key });
                }
                foreach (IGrouping<string?, Collider> same in uses.GroupBy(WhyNotFelt).Where(same => same.Key != null))
                {
                    Collider[] colliders = same.ToArray();
                    IEnumerable<Object> unreadable = colliders.OfType<MeshCollider>()
                        .Select(mesh => mesh.sharedMesh!).Where(mesh => mesh != null && !mesh.isReadable);
                    yield return new Finding(MessageType.Warning,
                        $"{MaterialWords.Names(colliders)}: the relief {uses.Key.name} cannot be felt, because " +
                        $"{same.Key}.",
                        colliders.Select(collider => collider.gameObject).Distinct().ToArray(),
                        Readability.RepairsOf(unreadable).ToArray());
                }
            }
        }

        /// <summary>Reliefs of terrain layers that do not lie where the layer's texture is seen.</summary>
        private static IEnumerable<Finding> CheckLayers(SceneContents scene) => scene.Maps.All
            .SelectMany(map => map.Rules)
            .Where(rule => rule.Subject == MaterialRuleSubject.TerrainLayer && rule.TerrainLayer != null &&
                rule.Relief != null && rule.Relief.IsBaked && !TerrainRelief.Fits(rule.Relief, rule.TerrainLayer))
            .Select(rule => new Finding(MessageType.Info,
                $"The relief {rule.Relief!.name} does not lie where the texture of the terrain layer " +
                $"{rule.TerrainLayer!.name} is seen, because its size or offset differs. Take it from the layer again.",
                new Object[] { rule.Relief, rule.TerrainLayer }));

        /// <summary>What is wrong with a relief itself, as a sentence; null when nothing is.</summary>
        public static string? ProblemOf(HapticRelief relief)
        {
            if (!relief.IsBaked)
            {
                return $"{relief.name} has no heights: it is not felt. Press {ReliefButton.Caption} on a Haptic " +
                    "Surface that uses it, or drop a mesh or a terrain layer in its Inspector.";
            }
            float texel = 1000f *
                Mathf.Max(relief.SizeMetres.x / relief.Columns, relief.SizeMetres.y / relief.Rows);
            return texel > CoarseTexelMillimetres
                ? $"{relief.name}: a texel is {texel:0.#} mm long, too coarse for details that a moving tip feels. " +
                    "Use a finer map, or a smaller size."
                : null;
        }

        /// <summary>Why a collider has no place in a relief's map, as the end of a sentence; null when it
        /// has.</summary>
        public static string? WhyNotFelt(Collider collider) => collider switch
        {
            BoxCollider _ => null,
            TerrainCollider _ => null,
            MeshCollider _ => MapRules.WhyNoCoordinates(collider, false),
            _ => "only boxes, terrains and mesh colliders say where in a map they are touched",
        };

        private static IEnumerable<HapticRelief> ReliefsOf(ColliderMaterial answer)
        {
            IEnumerable<HapticRelief?> reliefs = answer.Surface is object
                ? new[] { answer.Surface.Relief }
                : answer.ByRules.Parts.Where(part => part.CanBeFelt).Select(part => part.Relief);
            return reliefs.Where(relief => relief != null).Select(relief => relief!).Distinct();
        }
    }
}
