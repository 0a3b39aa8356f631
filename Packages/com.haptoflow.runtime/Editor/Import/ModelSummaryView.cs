#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Draws the summary of a model.</summary>
    internal sealed class ModelSummaryView
    {
        private readonly ModelSummary summary;
        private readonly GUIContent labelsTitle;
        private bool showsLabels = true;

        public ModelSummaryView(ModelSummary summary)
        {
            this.summary = summary;
            labelsTitle = new GUIContent($"Labels ({summary.Labels.Count})",
                "The materials that a surface can have: name, category, stiffness of the spring model, mean kinetic " +
                "friction.");
        }

        public void Draw()
        {
            if (summary.Problem != null)
            {
                EditorGUILayout.HelpBox("This model cannot be used: " + summary.Problem, MessageType.Error);
                return;
            }
            EditorGUILayout.LabelField(summary.Title, EditorStyles.boldLabel);
            EditorGUILayout.LabelField(summary.Description, EditorStyles.wordWrappedLabel);
            EditorGUILayout.Space();
            foreach (SummaryRow row in summary.Origin)
            {
                EditorGUILayout.LabelField(row.Name, row.Value, EditorStyles.wordWrappedLabel);
            }
            EditorGUILayout.Space();
            EditorGUILayout.LabelField("Tiers: accuracy and time", EditorStyles.boldLabel);
            foreach (TierSummary tier in summary.Tiers)
            {
                DrawTier(tier);
            }
            EditorGUILayout.Space();
            DrawLabels();
        }

        private static void DrawTier(TierSummary tier)
        {
            EditorGUILayout.LabelField(tier.Name, tier.Network, EditorStyles.wordWrappedLabel);
            using (new EditorGUI.IndentLevelScope())
            {
                EditorGUILayout.LabelField("Accuracy", tier.Accuracy, EditorStyles.wordWrappedLabel);
                EditorGUILayout.LabelField("Time", tier.Time, EditorStyles.wordWrappedLabel);
            }
        }

        private void DrawLabels()
        {
            showsLabels = EditorGUILayout.Foldout(showsLabels, labelsTitle, true);
            if (!showsLabels)
            {
                return;
            }
            using (new EditorGUI.IndentLevelScope())
            {
                foreach (SummaryRow row in summary.Labels)
                {
                    EditorGUILayout.LabelField(row.Name, row.Value);
                }
            }
        }
    }
}
