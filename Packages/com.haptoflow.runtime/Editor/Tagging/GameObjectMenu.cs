#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
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
