#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Finds the material of a selected object: a Haptic Material, a surface, or an object with a material by
    /// its surface or by a rule. Main thread.</summary>
    internal readonly struct SelectedMaterial
    {
        private SelectedMaterial(Object? described, string remark = "") => (Described, Remark) = (described, remark);

        /// <summary>The surface or the Haptic Material with the description; null if the object has none.</summary>
        public Object? Described { get; }

        /// <summary>For display: the rule and the part of the object that were used, or why there is no material. Empty
        /// without a remark.</summary>
        public string Remark { get; }

        public static SelectedMaterial Of(Object? selected)
        {
            if (selected is GameObject owner && owner != null)
            {
                return OfObject(owner);
            }
            bool describes = selected != null && (selected is HapticMaterial || selected is HapticSurface);
            return new SelectedMaterial(describes ? selected : null);
        }

        /// <summary>In this order: the object's own surface, its colliders' material, a disabled surface.</summary>
        private static SelectedMaterial OfObject(GameObject owner)
        {
            bool hasOwn = owner.TryGetComponent(out HapticSurface own);
            if (hasOwn && own.enabled)
            {
                return new SelectedMaterial(own);
            }
            var maps = new SceneMaps();
            ColliderMaterial[] answers = SceneColliders.Below(new[] { owner }).Select(maps.Ask)
                .OrderBy(answer => answer.Collider.gameObject == owner ? 0 : 1).ToArray();
            ColliderMaterial? touchable = answers.FirstOrDefault(answer => answer.CanBeFelt);
            if (touchable != null)
            {
                return touchable.Surface is object ? new SelectedMaterial(touchable.Surface) : OfRule(owner, touchable);
            }
            HapticSurface? described = hasOwn ? own
                : answers.Length == 0 ? SurfaceRegistry.OwnerOf(owner.transform)
                : answers.Select(answer => SceneColliders.SurfaceOf(answer.Collider))
                    .FirstOrDefault(surface => surface != null);
            if (described != null)
            {
                return new SelectedMaterial(
                    described, described.isActiveAndEnabled ? "" : "its Haptic Surface is disabled");
            }
            return new SelectedMaterial(null, WhyNot(answers));
        }

        private static SelectedMaterial OfRule(GameObject owner, ColliderMaterial answer)
        {
            MappedCollider mapped = answer.ByRules;
            int index = 0;
            while (!mapped.Parts[index].CanBeFelt)
            {
                ++index;
            }
            MappedPart part = mapped.Parts[index];
            var remarks = new List<string>();
            if (answer.Collider.gameObject != owner)
            {
                remarks.Add(answer.Collider.name);
            }
            if (!mapped.IsUniform)
            {
                string kind = mapped.Facts.Terrain is object ? "layer" : "submesh";
                remarks.Add($"{kind} {index + 1} of {mapped.Parts.Count}");
            }
            remarks.Add(part.Explain());
            if (part.Mask is object)
            {
                remarks.Add(part.Material is object
                    ? $"without its mask {part.Mask.name}"
                    : $"the first material of its mask {part.Mask.name}");
            }
            return new SelectedMaterial(part.Material ?? FirstOf(part.Mask), string.Join("; ", remarks));
        }

        private static HapticMaterial? FirstOf(HapticMaskMap? mask) => mask is null
            ? null
            : new[] { mask.Red, mask.Green, mask.Blue, mask.Alpha }
                .Where(channel => channel.Use == MaskChannelUse.Material && channel.Material != null)
                .Select(channel => channel.Material).FirstOrDefault();

        private static string WhyNot(IReadOnlyCollection<ColliderMaterial> answers)
        {
            if (answers.Count == 0)
            {
                return "it has no collider that can be touched";
            }
            ColliderMaterial first = answers.FirstOrDefault(
                answer => answer.ByRules.Parts.Any(part => part.Map is object)) ?? answers.First();
            return first.ByRules.Parts.All(part => part.Map is null)
                ? "it has no Haptic Surface, and no rule matches"
                : first.Reason;
        }
    }
}
