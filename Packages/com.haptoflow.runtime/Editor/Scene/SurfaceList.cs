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

    /// <summary>Tagged and untagged colliders, of the selection where there is one, else of the scene.</summary>
    internal sealed class SurfaceList
    {
        private SurfaceList(IReadOnlyList<Collider> colliders, bool ofSelection)
        {
            OfSelection = ofSelection;
            Untagged = colliders
                .Where(collider => SceneColliders.SurfaceOf(collider) == null)
                .Select(collider => new SurfaceLine(collider, collider.name))
                .ToArray();
            Tagged = colliders
                .Where(collider => SceneColliders.SurfaceOf(collider) != null)
                .Select(collider => new SurfaceLine(
                    collider, collider.name + ": " + MaterialOf(SceneColliders.SurfaceOf(collider)!)))
                .ToArray();
        }

        public bool OfSelection { get; }

        public IReadOnlyList<SurfaceLine> Tagged { get; }

        public IReadOnlyList<SurfaceLine> Untagged { get; }

        /// <param name="selected">Objects; where none of them has a collider, the scene is listed.</param>
        public static SurfaceList Of(IReadOnlyList<GameObject> selected)
        {
            IReadOnlyList<Collider> near = SceneColliders.Below(selected);
            return near.Count > 0
                ? new SurfaceList(near, true)
                : new SurfaceList(SceneColliders.InScenes(), false);
        }

        private static string MaterialOf(HapticSurface surface)
        {
            LabelCatalog catalog = LabelCatalog.Current;
            MaterialDescription material = surface.SharedDescription;
            string first = catalog.TextOf(material.Label);
            return material.SecondLabel.Length == 0 ? first : first + " and " + catalog.TextOf(material.SecondLabel);
        }
    }
}
