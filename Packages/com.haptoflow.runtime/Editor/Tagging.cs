#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using System.Text.RegularExpressions;
using HaptoFlow.Model;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>Adds labels to objects, as one step of undo.</summary>
    internal static class Tagging
    {
        public static void Apply(IReadOnlyCollection<TagProposal> proposals, string undoName)
        {
            if (proposals.Count == 0)
            {
                return;
            }
            Undo.IncrementCurrentGroup();
            Undo.SetCurrentGroupName(undoName);
            int group = Undo.GetCurrentGroup();
            foreach (TagProposal proposal in proposals)
            {
                Tag(proposal.Owner, proposal.Label);
            }
            Undo.CollapseUndoOperations(group);
        }

        private static void Tag(GameObject owner, string label)
        {
            if (!owner.TryGetComponent(out HapticSurface surface))
            {
                surface = Undo.AddComponent<HapticSurface>(owner);
            }
            using var serialized = new SerializedObject(surface);
            serialized.FindProperty("own.label").stringValue = label;
            serialized.FindProperty("includeChildren").boolValue = true;
            serialized.ApplyModifiedProperties();
            if (Application.isPlaying)
            {
                surface.Refresh();
            }
        }
    }

    /// <summary>An object that can be tagged, with the label that its name or physics material suggests.</summary>
    /// <param name="Reason">What suggests the label: "name" or the physics material.</param>
    internal sealed record TagProposal(GameObject Owner, string Label, string Reason);

    /// <summary>The labels proposed for untagged colliders. Creating a plan changes no object.</summary>
    internal sealed class TagPlan
    {
        private readonly List<TagProposal> proposals = new List<TagProposal>();
        private readonly List<GameObject> unmatched = new List<GameObject>();
        private readonly HashSet<GameObject> decided = new HashSet<GameObject>();
        private readonly LabelMatcher matcher;

        private TagPlan(LabelMatcher matcher) => this.matcher = matcher;

        public IReadOnlyList<TagProposal> Proposals => proposals;

        /// <summary>Objects with untagged colliders for which nothing suggests a label.</summary>
        public IReadOnlyList<GameObject> Unmatched => unmatched;

        /// <summary>Plans a label for every untagged collider. The physics material is compared first, then the name of
        /// the object, then the names of its parents up to a root.</summary>
        /// <param name="roots">Parents above these objects are not compared.</param>
        public static TagPlan For(
            IEnumerable<Collider> colliders, IReadOnlyCollection<GameObject> roots, LabelMatcher matcher)
        {
            var plan = new TagPlan(matcher);
            foreach (Collider collider in colliders.Where(each => SceneColliders.SurfaceOf(each) == null))
            {
                plan.Decide(collider, roots);
            }
            return plan;
        }

        private void Decide(Collider collider, IReadOnlyCollection<GameObject> roots)
        {
            GameObject owner = collider.gameObject;
            Object? physics = collider.sharedMaterial;
            string? label = physics != null ? matcher.Propose(physics!.name) : null;
            if (label != null)
            {
                Add(owner, label, $"physics material {physics!.name}");
                return;
            }
            for (Transform? place = owner.transform; place != null; place = place.parent)
            {
                label = matcher.Propose(place.name);
                if (label != null)
                {
                    Add(place.gameObject, label, "name");
                    return;
                }
                if (roots.Contains(place.gameObject))
                {
                    break;
                }
            }
            if (decided.Add(owner))
            {
                unmatched.Add(owner);
            }
        }

        private void Add(GameObject owner, string label, string reason)
        {
            if (decided.Add(owner))
            {
                proposals.Add(new TagProposal(owner, label, reason));
            }
        }
    }

    /// <summary>The menu GameObject > HaptoFlow > Tag Selected: adds labels to the selected objects.</summary>
    internal static class GameObjectMenu
    {
        private const string Tag = "GameObject/HaptoFlow/Tag Selected by Name or Physics Material";
        private const int Priority = 11;

        [MenuItem(Tag, true, Priority)]
        internal static bool CanTag() => SelectedInScene().Length > 0;

        [MenuItem(Tag, false, Priority)]
        internal static void TagSelected(MenuCommand command)
        {
            // The Hierarchy's context menu calls this method once for each selected object.
            if (command.context == null || command.context == Selection.activeObject)
            {
                TagSelected(SelectedInScene(), new LabelMatcher(LabelCatalog.Current.Names));
            }
        }

        internal static void TagSelected(IReadOnlyCollection<GameObject> selected, LabelMatcher matcher)
        {
            TagPlan plan = TagPlan.For(SceneColliders.Below(selected), selected, matcher);
            Tagging.Apply(plan.Proposals, "Tag by Name or Physics Material");
            Debug.Log(Report(plan));
        }

        /// <summary>The selected objects of scenes. Prefab assets are left out, because they have to be opened to be
        /// changed.</summary>
        private static GameObject[] SelectedInScene() =>
            Selection.gameObjects.Where(each => !EditorUtility.IsPersistent(each)).ToArray();

        private static string Report(TagPlan plan)
        {
            if (plan.Proposals.Count == 0 && plan.Unmatched.Count == 0)
            {
                return "HaptoFlow: the selection has no untagged collider that can be felt.";
            }
            string tagged = plan.Proposals.Count == 0
                ? "tagged nothing"
                : "tagged " + string.Join(", ", plan.Proposals.Select(
                    each => $"{each.Owner.name} as {each.Label} ({each.Reason})"));
            string untagged = plan.Unmatched.Count == 0
                ? ""
                : "; left untagged, because neither name nor physics material suggests a label of the model: " +
                    string.Join(", ", plan.Unmatched.Select(each => each.name));
            return $"HaptoFlow: {tagged}{untagged}.";
        }
    }

    /// <summary>Proposes a label of the model from the name of an object or a physics material: for example wood for
    /// "Oak_Table".</summary>
    internal sealed class LabelMatcher
    {
        // Capitals before a capitalised word, a word with at most one capital, capitals.
        private static readonly Regex Word =
            new Regex(@"\p{Lu}+(?=\p{Lu}\p{Ll})|\p{Lu}?[\p{L}-[\p{Lu}]]+|\p{Lu}+", RegexOptions.CultureInvariant);

        private readonly LabelNames labels;
        private readonly (string Label, string[] Words)[] byLength;

        public LabelMatcher(LabelNames labels)
        {
            this.labels = labels;
            byLength = labels.All
                .Select(label => (label, words: WordsOf(label).ToArray()))
                .Where(entry => entry.words.Length > 0)
                .OrderByDescending(entry => entry.words.Length)
                .ToArray();
        }

        /// <summary>The label that a name suggests; null without one. The name of a label takes precedence over a
        /// synonym, an earlier word over a later one, and "metal mesh" over "metal".</summary>
        public string? Propose(string name)
        {
            string[] words = WordsOf(name).ToArray();
            return FindName(words) ?? words.Select(FindSynonym).FirstOrDefault(label => label != null);
        }

        private string? FindName(string[] words) => Enumerable.Range(0, words.Length)
            .SelectMany(start => byLength.Where(entry => IsAt(words, start, entry.Words)))
            .Select(entry => entry.Label).FirstOrDefault();

        private static bool IsAt(string[] words, int start, string[] labelWords) =>
            start + labelWords.Length <= words.Length &&
            labelWords.Zip(words.Skip(start), (wanted, word) => Forms(word).Contains(wanted)).All(fits => fits);

        private string? FindSynonym(string word)
        {
            foreach (string form in Forms(word))
            {
                if (LabelWords.All.TryGetValue(form, out string[] preferred))
                {
                    return preferred.Select(InModel).FirstOrDefault(label => label != null);
                }
            }
            return null;
        }

        private string? InModel(string label) => labels.TryFind(label, out int index) ? labels.All[index] : null;

        /// <summary>The word itself, and its possible singular forms.</summary>
        private static IEnumerable<string> Forms(string word)
        {
            yield return word;
            if (word.Length > 3 && word.EndsWith("s", StringComparison.Ordinal))
            {
                yield return word.Substring(0, word.Length - 1);
            }
            if (word.Length > 4 && word.EndsWith("es", StringComparison.Ordinal))
            {
                yield return word.Substring(0, word.Length - 2);
            }
        }

        /// <summary>Splits a name into words at capitals and at characters that are no letters: "OakTable_02" into oak
        /// and table.</summary>
        private static IEnumerable<string> WordsOf(string name) =>
            Word.Matches(name).Cast<Match>().Select(word => word.Value.ToLowerInvariant());
    }

    /// <summary>Synonyms for materials, each with the labels that fit it, the best first. Words that often mean
    /// something else in the name of an object, such as "mesh" and "mat", are left out.</summary>
    internal static class LabelWords
    {
        private static readonly (string Labels, string Words)[] Groups =
        {
            ("wood", "oak pine walnut birch maple mahogany cedar beech teak spruce bamboo timber lumber plank wooden " +
                "parquet hardwood log"),
            ("plywood, wood", "ply mdf osb chipboard particleboard fibreboard fiberboard hardboard"),
            ("stone", "rock marble granite slate limestone sandstone cobble cobblestone pebble boulder basalt " +
                "travertine"),
            ("concrete, stone", "cement asphalt tarmac plaster stucco mortar"),
            ("brick, stone", "clinker masonry"),
            ("ceramic, glass", "porcelain tile earthenware terracotta pottery stoneware faience"),
            ("glass, ceramic", "crystal mirror window windshield"),
            ("metal", "steel iron aluminium aluminum brass copper bronze chrome titanium zinc nickel tin gold silver " +
                "metallic alloy"),
            ("metal mesh, metal", "grate grating grille chainlink wiremesh"),
            ("plastic", "acrylic pvc vinyl polymer plexiglass polycarbonate bakelite melamine laminate"),
            ("rubber, plastic", "silicone latex neoprene tyre tire eraser"),
            ("leather", "suede leatherette cowhide"),
            ("cotton", "cloth fabric linen textile canvas denim silk polyester wool curtain towel"),
            ("corduroy, cotton", "velvet velour"),
            ("jute, cotton", "burlap hessian sackcloth sisal hemp rope"),
            ("fur, carpet", "pelt plush fleece furry fluffy"),
            ("paper, cardboard", "newspaper parchment poster"),
            ("cardboard, paper", "carton paperboard corrugated"),
            ("sandpaper, stone", "emery abrasive"),
            ("carpet, cotton", "rug doormat tatami moquette"),
        };

        /// <summary>The labels for a word in lower case, in order of preference.</summary>
        public static IReadOnlyDictionary<string, string[]> All { get; } = Groups
            .SelectMany(group => group.Words.Split(' '), (group, word) => (word, labels: group.Labels.Split(", ")))
            .ToDictionary(entry => entry.word, entry => entry.labels, StringComparer.Ordinal);
    }
}
