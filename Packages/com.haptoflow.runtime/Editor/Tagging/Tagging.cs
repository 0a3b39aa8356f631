#nullable enable
using System.Collections.Generic;
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
}
