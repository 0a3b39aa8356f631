#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The Inspector of a material that surfaces share.</summary>
    [CustomEditor(typeof(HapticMaterial))]
    [CanEditMultipleObjects]
    internal sealed class HapticMaterialEditor : UnityEditor.Editor
    {
        internal static readonly GUIContent Preview = new GUIContent("Preview",
            "Preview opens the Texture Preview with this material, to hear and see it without a headset.");

        private readonly MaterialSummaryView view = new MaterialSummaryView();

        public override void OnInspectorGUI()
        {
            if (targets.Length == 1 && ((HapticMaterial)target).IsLearnt)
            {
                view.Draw(((HapticMaterial)target).Learnt);
                EditorGUILayout.Space();
            }
            Draw(serializedObject);
            if (GUILayout.Button(Preview))
            {
                TexturePreviewWindow.Open(target);
            }
        }

        internal static void Draw(SerializedObject material)
        {
            material.Update();
            EditorGUILayout.PropertyField(material.FindProperty("description"), GUIContent.none);
            material.ApplyModifiedProperties();
        }
    }
}
