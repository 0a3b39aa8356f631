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
}
