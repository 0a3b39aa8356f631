#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The page Project Settings > HaptoFlow.</summary>
    internal static class HaptoFlowSettingsPage
    {
        public const string Path = "Project/HaptoFlow";

        private static readonly GUIContent Asset = new GUIContent("Asset",
            "The settings are saved in this asset.");
        private static readonly GUIContent Restart = new GUIContent("Restart Engine",
            "Restart Engine applies changes of model, update rate, budget and full scale in play mode.");

        private static SerializedObject? edited;

        [SettingsProvider]
        internal static SettingsProvider Create() =>
            new SettingsProvider(Path, SettingsScope.Project, HaptoFlowSettingsFields.Keywords)
            {
                guiHandler = _ => Draw(),
            };

        internal static void Draw()
        {
            HaptoFlowSettings? settings = ProjectSettingsAsset.Find();
            if (settings == null)
            {
                edited = null;
                DrawCreate();
                return;
            }
            if (edited == null || edited.targetObject != settings)
            {
                edited = new SerializedObject(settings);
            }
            using (new EditorGUI.DisabledScope(true))
            {
                EditorGUILayout.ObjectField(Asset, settings, typeof(HaptoFlowSettings), false);
            }
            if (!ProjectSettingsAsset.ReachesPlayers(settings))
            {
                DrawMissingPreload(settings);
            }
            EditorGUILayout.Space();
            HaptoFlowSettingsFields.Draw(edited);
            DrawRestart();
        }

        private static void DrawCreate()
        {
            EditorGUILayout.HelpBox("This project has no HaptoFlow settings. The editor uses built-in ones with the " +
                "package's model; a player build would have no model and stay silent.",
                MessageType.Warning);
            if (GUILayout.Button("Create Settings"))
            {
                ProjectSettingsAsset.FindOrCreate();
            }
        }

        private static void DrawMissingPreload(HaptoFlowSettings settings)
        {
            EditorGUILayout.HelpBox("These settings are not among the preloaded assets: a player build would not " +
                "include them.", MessageType.Warning);
            if (GUILayout.Button("Add to Preloaded Assets"))
            {
                ProjectSettingsAsset.Preload(settings);
            }
        }

        private static void DrawRestart()
        {
            if (!Application.isPlaying)
            {
                return;
            }
            EditorGUILayout.Space();
            if (GUILayout.Button(Restart))
            {
                Haptics.Restart();
            }
        }
    }

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

    [CustomEditor(typeof(HaptoFlowSettings))]
    [CanEditMultipleObjects]
    internal sealed class HaptoFlowSettingsEditor : UnityEditor.Editor
    {
        private bool isOfProject;

        private void OnEnable() => isOfProject = target == ProjectSettingsAsset.Find();

        public override void OnInspectorGUI()
        {
            HaptoFlowSettingsFields.Draw(serializedObject);
            if (!isOfProject && targets.Length == 1)
            {
                EditorGUILayout.HelpBox("The project uses other settings (Project Settings > HaptoFlow). These are " +
                    "used only where a script sets HaptoFlowSettings.Active.", MessageType.Info);
            }
        }
    }
}
