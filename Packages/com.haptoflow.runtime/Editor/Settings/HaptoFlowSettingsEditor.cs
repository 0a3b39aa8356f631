#nullable enable
using UnityEditor;

namespace HaptoFlow.Editor
{
    /// <summary>The Inspector of a settings asset.</summary>
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
