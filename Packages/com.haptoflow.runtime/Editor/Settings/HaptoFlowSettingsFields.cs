#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The fields of the settings, as their Inspector and the project settings page show them.</summary>
    internal static class HaptoFlowSettingsFields
    {
        private static readonly GUIContent Model = new GUIContent("Model", "The model is the .haptoflow file that " +
            "generates the vibration.");
        private static readonly GUIContent Quality = new GUIContent("Quality",
            "The quality chooses the tier of the model. Auto measures this machine and chooses the most accurate " +
            "tier that fits the budget. Fine chooses the most accurate tier if the model has none of that name.");
        private static readonly GUIContent Budget = new GUIContent("Budget Share",
            "With the quality Auto, inference may take this share of the time between two contact states, 0.01 to 1.");
        private static readonly GUIContent Follow = new GUIContent("Follow Display",
            "The update rate is the refresh rate of the headset, or of the screen, read when the engine starts.");
        private static readonly GUIContent Rate = new GUIContent("Update Rate (Hz)",
            "The update rate is the number of contact states per second. It is used when Follow Display is off, or " +
            "when the display does not report its rate.");
        private static readonly GUIContent Ceiling = new GUIContent("Safety Ceiling",
            "The safety ceiling is the largest magnitude of an output sample. 1 is full scale.");
        private static readonly GUIContent FullScale = new GUIContent("Full Scale (m/s\u00b2)",
            "The full scale is the acceleration of an output sample of 1. A smaller value gives a stronger output.");

        private static readonly GUIContent MaterialMap = new GUIContent("Material Map",
            "The material map assigns materials to objects by rules, in every scene. When it is empty, only objects " +
            "with a Haptic Surface are felt, and those that the map of a single scene matches.");

        /// <summary>The words under which the search box of Project Settings finds the page.</summary>
        public static readonly string[] Keywords =
        {
            "HaptoFlow", "haptic", "texture", "model", "quality", "draft", "standard", "fine", "update rate", "display",
            "ceiling", "full scale", "material map", "rules",
        };

        public static void Draw(SerializedObject settings)
        {
            settings.Update();
            SerializedProperty model = settings.FindProperty("model");
            SerializedProperty quality = settings.FindProperty("quality");
            // Read before any field is drawn, so that layout and drawing show the same fields.
            bool lacksModel = model.objectReferenceValue == null && !model.hasMultipleDifferentValues;
            EditorGUILayout.PropertyField(model, Model);
            if (lacksModel)
            {
                EditorGUILayout.HelpBox("The field Model is empty: nothing is felt.", MessageType.Warning);
            }
            EditorGUILayout.PropertyField(quality, Quality);
            bool usesBudget = quality.hasMultipleDifferentValues ||
                quality.enumValueIndex == (int)HapticQuality.Auto;
            using (new EditorGUI.DisabledScope(!usesBudget))
            {
                EditorGUILayout.PropertyField(settings.FindProperty("budgetShare"), Budget);
            }
            EditorGUILayout.PropertyField(settings.FindProperty("followDisplay"), Follow);
            EditorGUILayout.PropertyField(settings.FindProperty("updateRateHz"), Rate);
            EditorGUILayout.PropertyField(settings.FindProperty("ceiling"), Ceiling);
            EditorGUILayout.PropertyField(settings.FindProperty("fullScaleMps2"), FullScale);
            EditorGUILayout.PropertyField(settings.FindProperty("materialMap"), MaterialMap);
            if (settings.ApplyModifiedProperties() && Application.isPlaying)
            {
                // The quality changes with the next segment, all other fields when the engine is restarted.
                HapticSession.Existing?.SetQuality(HaptoFlowSettings.Active.Quality);
            }
        }
    }
}
