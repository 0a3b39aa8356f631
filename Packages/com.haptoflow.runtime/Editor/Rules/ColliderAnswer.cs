#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The answer to "Why does this feel like wood?" for one collider.</summary>
    internal sealed class ColliderAnswer
    {
        /// <param name="surface">The surface that counts; null where rules do.</param>
        /// <param name="byRules">What the rules say, or would say without the surface.</param>
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

        /// <summary>What it feels like: one material, or one for each of its parts that differ.</summary>
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

        /// <summary>Why, by the parts of <see cref="Material"/>.</summary>
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
