#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>One line of the overlay.</summary>
    internal readonly struct SurfaceLine
    {
        public SurfaceLine(Collider collider, string text)
        {
            Collider = collider;
            Text = text;
        }

        public Collider Collider { get; }

        public string Text { get; }
    }

    /// <summary>What colliders feel like and by which rule, and which are not felt: of the selection where there is
    /// one, else of the scene.</summary>
    internal sealed class SurfaceList
    {
        private SurfaceList(IReadOnlyList<Collider> colliders, bool ofSelection)
        {
            OfSelection = ofSelection;
            var maps = new SceneMaps();
            ColliderAnswer[] answers = colliders.Select(maps.Ask).ToArray();
            NotFelt = answers.Where(answer => !answer.CanBeFelt).Select(LineOf).ToArray();
            Felt = answers.Where(answer => answer.CanBeFelt).Select(LineOf).ToArray();
        }

        public bool OfSelection { get; }

        public IReadOnlyList<SurfaceLine> Felt { get; }

        public IReadOnlyList<SurfaceLine> NotFelt { get; }

        /// <param name="selected">Objects; where none of them has a collider, the scene is listed.</param>
        public static SurfaceList Of(IReadOnlyList<GameObject> selected)
        {
            IReadOnlyList<Collider> near = SceneColliders.Below(selected);
            return near.Count > 0
                ? new SurfaceList(near, true)
                : new SurfaceList(SceneColliders.InScenes(), false);
        }

        /// <summary>A surface's own line needs no reason; what a rule decides does, also where it is nothing.</summary>
        private static SurfaceLine LineOf(ColliderAnswer answer)
        {
            string felt = answer.CanBeFelt ? $"{answer.Collider.name}: {answer.Material}" : answer.Collider.name;
            bool isByRule = answer.Surface is null && answer.ByRules.Parts.Any(part => part.Map is object);
            return new SurfaceLine(answer.Collider, isByRule ? $"{felt} ({answer.Reason})" : felt);
        }
    }
}
