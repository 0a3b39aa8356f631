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
            "Opens the Texture Preview on this material: heard and seen without a headset.");

        public override void OnInspectorGUI()
        {
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
