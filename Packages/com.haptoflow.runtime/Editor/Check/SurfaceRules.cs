#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Checks that every surface has labels of the model, and a collider that can be felt.</summary>
    internal static class SurfaceRules
    {
        public static IEnumerable<Finding> Check(SceneContents scene)
        {
            LabelCatalog catalog = LabelCatalog.Current;
            var seen = new HashSet<Object>();
            foreach (HapticSurface surface in scene.Surfaces)
            {
                // A material that several surfaces share is checked once.
                HapticMaterial? shared = surface.SharedMaterial;
                Object owner = shared != null ? (Object)shared : surface;
                if (seen.Add(owner))
                {
                    string root = shared != null ? "description." : "own.";
                    MaterialDescription material = surface.SharedDescription;
                    foreach (Finding finding in CheckLabels(catalog, owner, material, root))
                    {
                        yield return finding;
                    }
                }
                bool canBeFelt = SceneColliders.Below(new[] { surface.gameObject })
                    .Any(collider => SceneColliders.SurfaceOf(collider) == surface);
                if (!canBeFelt)
                {
                    yield return new Finding(MessageType.Warning,
                        $"{surface.name} is tagged, but has no collider that can be felt. Add a box, sphere, " +
                        "capsule, character, mesh or terrain collider that is enabled and no " +
                        "trigger.", new[] { surface });
                }
            }
        }

        internal static IEnumerable<Finding> CheckLabels(
            LabelCatalog catalog, Object owner, MaterialDescription material, string root)
        {
            if (material.Label.Length == 0 && material.SecondLabel.Length == 0)
            {
                yield return new Finding(MessageType.Warning, $"{owner.name} has no label: it is not felt.",
                    new[] { owner });
            }
            if (catalog.IsUnknown(material.Label))
            {
                yield return Unknown(catalog, owner, material.Label, root + "label");
            }
            if (catalog.IsUnknown(material.SecondLabel))
            {
                yield return Unknown(catalog, owner, material.SecondLabel, root + "secondLabel");
            }
        }

        private static Finding Unknown(LabelCatalog catalog, Object owner, string label, string path)
        {
            IReadOnlyList<string> near = catalog.Names.NearMatches(label);
            string remedy = near.Count > 0
                ? "near matches: " + string.Join(", ", near)
                : "its labels are: " + string.Join(", ", catalog.Names.All);
            Repair[] repairs = near
                .Select(name => new Repair($"Use \"{name}\"", () => SetLabel(owner, path, name)))
                .ToArray();
            return new Finding(MessageType.Warning,
                $"{owner.name}: the model has no label \"{label}\"; {remedy}.", new[] { owner }, repairs);
        }

        private static void SetLabel(Object owner, string path, string label) =>
            SerializedFields.Set(owner, path, property => property.stringValue = label);
    }
}
