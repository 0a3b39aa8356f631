#nullable enable
using UnityEditor;

namespace HaptoFlow.Editor
{
    /// <summary>The rows of property drawers.</summary>
    internal static class InspectorRows
    {
        /// <summary>The distance from one row to the next.</summary>
        public static float Height => EditorGUIUtility.singleLineHeight + EditorGUIUtility.standardVerticalSpacing;
    }
}
