#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Draws a channel of a mask: a material, or a factor between two values.</summary>
    [CustomPropertyDrawer(typeof(MaskChannel))]
    internal sealed class MaskChannelDrawer : PropertyDrawer
    {
        private static readonly GUIContent Lowest = new GUIContent("At Black");
        private static readonly GUIContent Highest = new GUIContent("At White");

        public override float GetPropertyHeight(SerializedProperty property, GUIContent label)
        {
            MaskChannelUse use = UseOf(property);
            int rows = use == MaskChannelUse.Nothing ? 1 : use == MaskChannelUse.Material ? 2 : 3;
            return InspectorRows.Height * rows - EditorGUIUtility.standardVerticalSpacing;
        }

        public override void OnGUI(Rect position, SerializedProperty property, GUIContent label)
        {
            MaskChannelUse use = UseOf(property);
            var row = new Rect(position.x, position.y, position.width, EditorGUIUtility.singleLineHeight);
            EditorGUI.PropertyField(row, property.FindPropertyRelative("use"), label);
            if (use == MaskChannelUse.Nothing)
            {
                return;
            }
            using var indent = new EditorGUI.IndentLevelScope();
            row.y += InspectorRows.Height;
            if (use == MaskChannelUse.Material)
            {
                EditorGUI.PropertyField(row, property.FindPropertyRelative("material"));
                return;
            }
            EditorGUI.PropertyField(row, property.FindPropertyRelative("lowest"), Lowest);
            row.y += InspectorRows.Height;
            EditorGUI.PropertyField(row, property.FindPropertyRelative("highest"), Highest);
        }

        private static MaskChannelUse UseOf(SerializedProperty property) =>
            (MaskChannelUse)property.FindPropertyRelative("use").enumValueIndex;
    }
}
