#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>What a collider feels like, and why: by a Haptic Surface or by the rules of maps.</summary>
    internal sealed class ColliderAnswer
    {
        /// <param name="surface">The surface that assigns the material; null when rules do.</param>
        /// <param name="byRules">The material by the rules, which applies when there is no surface.</param>
        public ColliderAnswer(Collider collider, HapticSurface? surface, FeltCollider byRules)
        {
            Collider = collider;
            Surface = surface;
            ByRules = byRules;
        }

        public Collider Collider { get; }

        public HapticSurface? Surface { get; }

        public FeltCollider ByRules { get; }

        public bool CanBeFelt => Surface is object || ByRules.CanBeFelt;

        /// <summary>The material as text, or the different materials of its parts.</summary>
        public string Material
        {
            get
            {
                if (Surface is object)
                {
                    string material = FeltWords.Of(Surface.SharedDescription);
                    return Surface.Mask != null ? $"{material}, masked by {Surface.Mask.name}" : material;
                }
                return string.Join("; ", Distinct().Select(part => FeltWords.Of(part)));
            }
        }

        /// <summary>The reasons for the parts of <see cref="Material"/>, as text.</summary>
        public string Reason => Surface is object
            ? $"Haptic Surface on \"{Surface.name}\""
            : string.Join("; ", Distinct().Select(part => part.Explain()));

        /// <summary>For example "Table: wood (rule 2 of "Rooms": tag "Floor")".</summary>
        public override string ToString() => $"{Collider.name}: {Material} ({Reason})";

        private IEnumerable<FeltPart> Distinct()
        {
            IReadOnlyList<FeltPart> parts = ByRules.Parts;
            return parts.Where((part, index) => parts.Take(index).All(before => !before.IsSameAs(part)));
        }
    }
}
