#nullable enable
using System.Collections.Generic;
using UnityEditor;

namespace HaptoFlow.Editor
{
    /// <summary>Draws the figures of a running scene.</summary>
    internal static class ReadoutView
    {
        public static void Draw(string title, IReadOnlyList<SummaryRow> rows)
        {
            EditorGUILayout.LabelField(title, EditorStyles.boldLabel);
            for (int index = 0; index < rows.Count; ++index)
            {
                EditorGUILayout.LabelField(rows[index].Name, rows[index].Value);
            }
        }
    }
}
