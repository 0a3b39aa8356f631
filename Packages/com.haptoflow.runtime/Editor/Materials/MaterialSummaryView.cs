#nullable enable
using UnityEditor;

namespace HaptoFlow.Editor
{
    /// <summary>Draws the summary of a learnt material, and updates it when the text or the model changes.</summary>
    internal sealed class MaterialSummaryView
    {
        private string text = "";
        private HapticModelAsset? model;
        private MaterialSummary? summary;

        /// <param name="material">The text of a material file.</param>
        public void Draw(string material)
        {
            HapticModelAsset? current = LabelCatalog.ModelInUse();
            if (summary == null || !ReferenceEquals(material, text) || !ReferenceEquals(current, model))
            {
                text = material;
                model = current;
                summary = MaterialSummary.Of(material, current);
            }
            Draw(summary);
        }

        public static void Draw(MaterialSummary summary)
        {
            if (summary.Problem != null)
            {
                EditorGUILayout.HelpBox("This material cannot be used: " + summary.Problem, MessageType.Error);
                return;
            }
            EditorGUILayout.LabelField(summary.Title, EditorStyles.boldLabel);
            if (summary.Description.Length > 0)
            {
                EditorGUILayout.LabelField(summary.Description, EditorStyles.wordWrappedLabel);
            }
            if (summary.Mismatch != null)
            {
                EditorGUILayout.HelpBox(summary.Mismatch, MessageType.Warning);
            }
            foreach (SummaryRow row in summary.Rows)
            {
                EditorGUILayout.LabelField(row.Name, row.Value, EditorStyles.wordWrappedLabel);
            }
        }
    }
}
