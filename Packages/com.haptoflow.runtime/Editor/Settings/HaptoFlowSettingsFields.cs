#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The fields of the settings, as their Inspector and the project settings page show them.</summary>
    internal static class HaptoFlowSettingsFields
    {
        private static readonly GUIContent Rate = new GUIContent("Update Rate (Hz)");
        private static readonly GUIContent Ceiling = new GUIContent("Safety Ceiling");
        private static readonly GUIContent FullScale = new GUIContent("Full Scale (m/s\u00b2)");

        /// <summary>The words under which the search box of Project Settings finds the page.</summary>
        public static readonly string[] Keywords =
        {
            "HaptoFlow", "haptic", "texture", "model", "quality", "sketch", "draft", "standard", "update rate",
            "display", "ceiling", "full scale", "material map", "rules",
        };

        public static void Draw(SerializedObject settings)
        {
            settings.Update();
            SerializedProperty model = settings.FindProperty("model");
            SerializedProperty quality = settings.FindProperty("quality");
            // Read before any field is drawn, so that layout and drawing show the same fields.
            bool lacksModel = model.objectReferenceValue == null && !model.hasMultipleDifferentValues;
            EditorGUILayout.PropertyField(model);
            if (lacksModel)
            {
                EditorGUILayout.HelpBox("The field Model is empty: nothing is felt.", MessageType.Warning);
            }
            EditorGUILayout.PropertyField(quality);
            bool usesBudget = quality.hasMultipleDifferentValues ||
                quality.enumValueIndex == (int)HapticQuality.Auto;
            using (new EditorGUI.DisabledScope(!usesBudget))
            {
                EditorGUILayout.PropertyField(settings.FindProperty("budgetShare"));
            }
            EditorGUILayout.PropertyField(settings.FindProperty("followDisplay"));
            EditorGUILayout.PropertyField(settings.FindProperty("updateRateHz"), Rate);
            EditorGUILayout.PropertyField(settings.FindProperty("ceiling"), Ceiling);
            EditorGUILayout.PropertyField(settings.FindProperty("fullScaleMps2"), FullScale);
            EditorGUILayout.PropertyField(settings.FindProperty("materialMap"));
            if (settings.ApplyModifiedProperties() && Application.isPlaying)
            {
                // The quality changes with the next segment, all other fields when the engine is restarted.
                HapticSession.Existing?.SetQuality(HaptoFlowSettings.Active.Quality);
            }
        }
    }
}
