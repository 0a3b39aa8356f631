#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Places the fields of a property drawer, one row below the other.</summary>
    internal sealed class InspectorRows
    {
        private readonly SerializedProperty property;
        private Rect row;

        public InspectorRows(Rect position, SerializedProperty property) => (this.property, row) = (
            property, new Rect(position.x, position.y, position.width, EditorGUIUtility.singleLineHeight));

        /// <summary>The height of a number of rows.</summary>
        public static float Height(int rows) =>
            rows * (EditorGUIUtility.singleLineHeight + EditorGUIUtility.standardVerticalSpacing) -
            EditorGUIUtility.standardVerticalSpacing;

        /// <summary>The place of the next row.</summary>
        public Rect Next()
        {
            Rect place = row;
            row.y += row.height + EditorGUIUtility.standardVerticalSpacing;
            return place;
        }

        /// <summary>Draws a field in the next row; without a title, by its name.</summary>
        public void Field(string name, GUIContent? title = null) =>
            EditorGUI.PropertyField(Next(), property.FindPropertyRelative(name), title);
    }
}
