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
        public override void OnInspectorGUI() => Draw(serializedObject);

        internal static void Draw(SerializedObject material)
        {
            material.Update();
            EditorGUILayout.PropertyField(material.FindProperty("description"), GUIContent.none);
            material.ApplyModifiedProperties();
        }
    }
}
