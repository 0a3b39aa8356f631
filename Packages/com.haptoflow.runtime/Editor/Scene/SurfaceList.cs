#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>A line of the overlay.</summary>
    internal sealed record SurfaceLine(Collider Collider, string Text);

    /// <summary>Lists what colliders feel like and by which rule, and which colliders are not felt: those of the
    /// selection, or those of the open scenes when the selection has none.</summary>
    internal sealed class SurfaceList
    {
        private SurfaceList(IReadOnlyList<Collider> colliders, bool ofSelection)
        {
            OfSelection = ofSelection;
            var maps = new SceneMaps();
            ColliderMaterial[] answers = colliders.Select(maps.Ask).ToArray();
            NotFelt = answers.Where(answer => !answer.CanBeFelt).Select(LineOf).ToArray();
            Felt = answers.Where(answer => answer.CanBeFelt).Select(LineOf).ToArray();
        }

        public bool OfSelection { get; }

        public IReadOnlyList<SurfaceLine> Felt { get; }

        public IReadOnlyList<SurfaceLine> NotFelt { get; }

        /// <summary>Lists the colliders of the selected objects, or of the open scenes.</summary>
        /// <param name="selected">The selected objects.</param>
        public static SurfaceList Of(IReadOnlyList<GameObject> selected)
        {
            IReadOnlyList<Collider> ofSelection = SceneColliders.Below(selected);
            return ofSelection.Count > 0
                ? new SurfaceList(ofSelection, true)
                : new SurfaceList(SceneColliders.InScenes(), false);
        }

        /// <summary>The line of a collider, with the reason when a rule decides.</summary>
        private static SurfaceLine LineOf(ColliderMaterial answer)
        {
            string felt = answer.CanBeFelt ? $"{answer.Collider.name}: {answer.Material}" : answer.Collider.name;
            bool isByRule = answer.Surface is null && answer.ByRules.Parts.Any(part => part.Map is object);
            return new SurfaceLine(answer.Collider, isByRule ? $"{felt} ({answer.Reason})" : felt);
        }
    }
}
