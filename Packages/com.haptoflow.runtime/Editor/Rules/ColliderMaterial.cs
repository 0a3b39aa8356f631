#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>What a collider feels like, and why: by a Haptic Surface or by the rules of maps.</summary>
    /// <param name="Surface">The surface that assigns the material; null when rules do.</param>
    /// <param name="ByRules">The material by the rules, which applies when there is no surface.</param>
    internal sealed record ColliderMaterial(Collider Collider, HapticSurface? Surface, MappedCollider ByRules)
    {
        public bool CanBeFelt => Surface is object || ByRules.CanBeFelt;

        /// <summary>The material as text, or the different materials of its parts.</summary>
        public string Material
        {
            get
            {
                if (Surface is object)
                {
                    string material = MaterialWords.Of(Surface.SharedDescription);
                    return Surface.Mask != null ? $"{material}, masked by {Surface.Mask.name}" : material;
                }
                return string.Join("; ", Distinct().Select(part => MaterialWords.Of(part)));
            }
        }

        /// <summary>The reasons for the parts of <see cref="Material"/>, as text.</summary>
        public string Reason => Surface is object
            ? $"Haptic Surface on \"{Surface.name}\""
            : string.Join("; ", Distinct().Select(part => part.Explain()));

        /// <summary>For example "Table: wood (rule 2 of "Rooms": tag "Floor")".</summary>
        public override string ToString() => $"{Collider.name}: {Material} ({Reason})";

        private IEnumerable<MappedPart> Distinct()
        {
            IReadOnlyList<MappedPart> parts = ByRules.Parts;
            return parts.Where((part, index) => parts.Take(index).All(before => !before.IsSameAs(part)));
        }
    }
}
