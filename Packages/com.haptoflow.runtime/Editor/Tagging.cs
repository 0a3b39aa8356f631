#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEngine;

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
}
