#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>Finds the colliders that can be felt and their surfaces in edit mode, in the same way as
    /// <see cref="HapticSurface"/> does in play mode.</summary>
    internal static class SceneColliders
    {
        /// <summary>Whether the collider is of a kind that a tip can feel.</summary>
        public static bool CanBeFelt(Collider collider) => !collider.isTrigger && ColliderProbe.IsSupportedKind(collider);

        /// <summary>The surface that a collider belongs to; null for an untagged collider.</summary>
        public static HapticSurface? SurfaceOf(Collider collider)
        {
            HapticSurface? owner = SurfaceRegistry.OwnerOf(collider.transform);
            bool isIncluded = owner != null &&
                (owner.IncludeChildren || ReferenceEquals(owner.gameObject, collider.gameObject));
            return isIncluded ? owner : null;
        }

        /// <summary>The colliders in the open scenes that can be felt, sorted by name.</summary>
        public static IReadOnlyList<Collider> InScenes() => Sorted(
            Object.FindObjectsByType<Collider>(FindObjectsInactive.Exclude, FindObjectsSortMode.None));

        /// <summary>The colliders on these objects and their children that can be felt, sorted by name.</summary>
        public static IReadOnlyList<Collider> Below(IEnumerable<GameObject> roots)
        {
            var all = new HashSet<Collider>();
            var here = new List<Collider>();
            foreach (GameObject root in roots)
            {
                root.GetComponentsInChildren(true, here);
                all.UnionWith(here);
            }
            return Sorted(all);
        }

        private static IReadOnlyList<Collider> Sorted(IEnumerable<Collider> colliders) => colliders
            .Where(collider => collider.enabled && CanBeFelt(collider))
            .OrderBy(collider => collider.name, System.StringComparer.Ordinal)
            .ToArray();
    }

    /// <summary>A subscription to changes of the open scenes and of the project, undo included.</summary>
    internal sealed class SceneChanges : IDisposable
    {
        private readonly Action changed;

        public SceneChanges(Action changed)
        {
            this.changed = changed;
            EditorApplication.hierarchyChanged += changed;
            EditorApplication.projectChanged += changed;
            ObjectChangeEvents.changesPublished += OnChangesPublished;
        }

        public void Dispose()
        {
            EditorApplication.hierarchyChanged -= changed;
            EditorApplication.projectChanged -= changed;
            ObjectChangeEvents.changesPublished -= OnChangesPublished;
        }

        private void OnChangesPublished(ref ObjectChangeEventStream stream) => changed();
    }

    /// <summary>Gives copies of surfaces in the open scenes seeds of their own. The surface that had a seed before keeps
    /// it; prefab assets are not searched.</summary>
    internal static class SurfaceSeedKeeper
    {
        // The seed of every surface of the open scenes, by instance, when it was last looked at.
        private static Dictionary<int, uint> known = new Dictionary<int, uint>();

        /// <summary>Looks for copies; for changes of the hierarchy outside of play mode.</summary>
        public static void Renew()
        {
            if (EditorApplication.isPlayingOrWillChangePlaymode)
            {
                return;
            }
            // Those that had their seed before come first, so that they keep it.
            HapticSurface[] surfaces = Object.FindObjectsByType<HapticSurface>(
                    FindObjectsInactive.Include, FindObjectsSortMode.InstanceID)
                .Where(surface => surface.Seed != 0).OrderByDescending(IsKnown).ToArray();
            var taken = new HashSet<uint>();
            foreach (HapticSurface surface in surfaces)
            {
                if (!taken.Add(surface.Seed))
                {
                    GiveNew(surface);
                    taken.Add(surface.Seed);
                }
            }
            known = surfaces.ToDictionary(surface => surface.GetInstanceID(), surface => surface.Seed);
        }

        private static bool IsKnown(HapticSurface surface) =>
            known.TryGetValue(surface.GetInstanceID(), out uint seed) && seed == surface.Seed;

        // Through the serialised field, so that overrides of prefabs, unsaved changes and undo know of it.
        private static void GiveNew(HapticSurface surface)
        {
            using var copy = new SerializedObject(surface);
            copy.FindProperty("seed").uintValue = SurfaceSeeds.New();
            copy.ApplyModifiedProperties();
        }
    }

    /// <summary>The maps in use in the open scenes, found in the same way as <see cref="MaterialMaps"/> finds them in
    /// play mode.</summary>
    internal sealed class SceneMaps
    {
        private readonly HapticMaterialMapScope[] scopes;
        private readonly HapticMaterialMap? project;

        public SceneMaps()
        {
            scopes = Object.FindObjectsByType<HapticMaterialMapScope>(
                    FindObjectsInactive.Exclude, FindObjectsSortMode.None)
                .Where(scope => scope.enabled && scope.Map != null)
                .OrderBy(scope => scope.Order)
                .ToArray();
            HaptoFlowSettings? settings = Application.isPlaying
                ? HaptoFlowSettings.Active
                : ProjectSettingsAsset.Find();
            project = settings != null && settings.MaterialMap != null ? settings.MaterialMap : null;
        }

        public IReadOnlyList<HapticMaterialMap> All => scopes.Select(scope => scope.Map!).Append(project!)
            .Where(map => map != null).Distinct().ToArray();

        /// <summary>The maps for an object, in the order in which they apply.</summary>
        public IReadOnlyList<HapticMaterialMap> For(GameObject owner)
        {
            List<HapticMaterialMap> maps = scopes
                .Where(scope => scope.gameObject.scene == owner.scene).Select(scope => scope.Map!).ToList();
            if (project is object)
            {
                maps.Add(project);
            }
            return maps;
        }

        /// <summary>What a collider feels like, and why. A surface takes precedence over rules.</summary>
        public ColliderMaterial Ask(Collider collider)
        {
            HapticSurface? surface = SceneColliders.SurfaceOf(collider);
            bool isActive = surface != null && surface.enabled && surface.gameObject.activeInHierarchy;
            return new ColliderMaterial(
                collider, isActive ? surface : null, new MappedCollider(collider, For(collider.gameObject)));
        }
    }

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

    /// <summary>Describes in words what something feels like.</summary>
    internal static class MaterialWords
    {
        private const int MaximumNames = 8;

        /// <summary>The labels of a contact: "wood", "wood 60 %, stone 40 %", "nothing".</summary>
        public static string Of(in HapticContact contact)
        {
            LabelBlend blend = contact.Labels;
            if (blend.Count == 0)
            {
                return "nothing";
            }
            return blend.Count == 1 ? NameOf(blend.Label(0)) : string.Join(", ", Enumerable.Range(0, blend.Count)
                .Select(entry => string.Format(CultureInfo.InvariantCulture, "{0} {1:0} %",
                    NameOf(blend.Label(entry)), 100f * blend.Weight(entry))));
        }

        /// <summary>The labels of a description: "wood" or "wood and stone", with a remark for a label that the model
        /// does not have. </summary>
        public static string Of(MaterialDescription material)
        {
            LabelCatalog catalog = LabelCatalog.Current;
            string first = material.Learnt != null ? material.Learnt.name : catalog.TextOf(material.Label);
            return material.SecondLabel.Length == 0 ? first : first + " and " + catalog.TextOf(material.SecondLabel);
        }

        /// <summary>The name and the labels of an asset, or just the name when both are the same.</summary>
        public static string Of(HapticMaterial? material)
        {
            if (material == null)
            {
                return "nothing";
            }
            string labels = Of(material.Description);
            return material.name == labels ? labels : $"{material.name} ({labels})";
        }

        /// <summary>The material of a part of a collider, with its mask.</summary>
        public static string Of(in MappedPart part)
        {
            string material = Of(part.Material);
            return part.Mask is object ? $"{material}, masked by {part.Mask.name}" : material;
        }

        /// <summary>The first few names, and how many more there are.</summary>
        public static string Names(IReadOnlyCollection<Object> objects, int maximum = MaximumNames)
        {
            string names = string.Join(", ", objects.Take(maximum).Select(each => each.name));
            return objects.Count <= maximum ? names : $"{names} and {objects.Count - maximum} more";
        }

        private static string NameOf(int label)
        {
            HapticSession? session = HapticSession.Existing;
            IReadOnlyList<string> labels = Haptics.Labels;
            return label < labels.Count ? labels[label] : session?.Engine?.Material(label).Name ?? "";
        }
    }
}
