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
            return InspectorRows.Height(rows);
        }

        public override void OnGUI(Rect position, SerializedProperty property, GUIContent label)
        {
            MaskChannelUse use = UseOf(property);
            var rows = new InspectorRows(position, property);
            rows.Field("use", label);
            if (use == MaskChannelUse.Nothing)
            {
                return;
            }
            using var indent = new EditorGUI.IndentLevelScope();
            if (use == MaskChannelUse.Material)
            {
                rows.Field("material");
                return;
            }
            rows.Field("lowest", Lowest);
            rows.Field("highest", Highest);
        }

        private static MaskChannelUse UseOf(SerializedProperty property) =>
            (MaskChannelUse)property.FindPropertyRelative("use").enumValueIndex;
    }
}
