#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The fields of the settings, as their Inspector and the project settings page show them.</summary>
    internal static class HaptoFlowSettingsFields
    {
        private static readonly GUIContent Model = new GUIContent("Model", "The .haptoflow model that renders.");
        private static readonly GUIContent Quality = new GUIContent("Quality",
            "Which tier generates. Auto measures this machine and takes the most accurate tier that fits the budget; " +
            "Fine takes the most accurate one where the model has no tier of that name.");
        private static readonly GUIContent Budget = new GUIContent("Budget Share",
            "Auto: share of the time between two contact states that inference may take, 0.01 to 1.");
        private static readonly GUIContent Follow = new GUIContent("Follow Display",
            "The update rate is the refresh rate of the headset, or of the screen, as it is when the engine starts.");
        private static readonly GUIContent Rate = new GUIContent("Update Rate (Hz)",
            "Contact states a second: counts where the display is not followed, or does not say its rate.");
        private static readonly GUIContent Ceiling = new GUIContent("Safety Ceiling",
            "No output sample is above this, whatever happens; 1 is full scale.");
        private static readonly GUIContent FullScale = new GUIContent("Full Scale (m/s\u00b2)",
            "Acceleration that is full scale in the output. Smaller is stronger.");

        private static readonly GUIContent MaterialMap = new GUIContent("Material Map",
            "Says by rules which object is which material, in every scene. Empty: only objects with a Haptic Surface " +
            "are felt, and what maps of single scenes name.");

        /// <summary>Found by the search box of Project Settings.</summary>
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
            // Decided before it is changed: nothing is drawn that was not laid out.
            bool lacksModel = model.objectReferenceValue == null && !model.hasMultipleDifferentValues;
            EditorGUILayout.PropertyField(model, Model);
            if (lacksModel)
            {
                EditorGUILayout.HelpBox("Without a model nothing is felt.", MessageType.Warning);
            }
            EditorGUILayout.PropertyField(quality, Quality);
            bool budgetCounts = quality.hasMultipleDifferentValues ||
                quality.enumValueIndex == (int)HapticQuality.Auto;
            using (new EditorGUI.DisabledScope(!budgetCounts))
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
                // Quality counts from the next segment on, the rest when an engine starts anew.
                HapticSession.Existing?.SetQuality(HaptoFlowSettings.Active.Quality);
            }
        }
    }
}
