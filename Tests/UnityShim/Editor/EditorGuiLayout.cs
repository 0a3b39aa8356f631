using UnityEngine;
using UnityShim;

namespace UnityEditor
{
    public sealed partial class EditorGUILayout
    {
        private static readonly Rect Line = new Rect(0f, 0f, 400f, 18f);

        public static void LabelField(string label, params GUILayoutOption[] options) =>
            EditorScreen.Add(DrawnKind.Label, label);
        public static void LabelField(string label, GUIStyle style, params GUILayoutOption[] options) =>
            EditorScreen.Add(DrawnKind.Label, label);
        public static void LabelField(GUIContent label, params GUILayoutOption[] options) =>
            EditorScreen.Add(DrawnKind.Label, label.text, "", label.tooltip);
        public static void LabelField(GUIContent label, GUIStyle style, params GUILayoutOption[] options) =>
            EditorScreen.Add(DrawnKind.Label, label.text, "", label.tooltip);
        public static void LabelField(string label, string label2, params GUILayoutOption[] options) =>
            EditorScreen.Add(DrawnKind.Label, label, label2);
        public static void LabelField(string label, string label2, GUIStyle style, params GUILayoutOption[] options) =>
            EditorScreen.Add(DrawnKind.Label, label, label2);
        public static void LabelField(GUIContent label, GUIContent label2, params GUILayoutOption[] options) =>
            EditorScreen.Add(DrawnKind.Label, label.text, label2.text, label.tooltip);
        public static void LabelField(
            GUIContent label, GUIContent label2, GUIStyle style, params GUILayoutOption[] options) =>
            EditorScreen.Add(DrawnKind.Label, label.text, label2.text, label.tooltip);

        public static void HelpBox(string message, MessageType type) =>
            EditorScreen.Add(DrawnKind.Help, message, type.ToString());

        public static void Space()
        {
        }

        public static void Space(float width)
        {
        }

        public static Rect GetControlRect(params GUILayoutOption[] options) => Line;

        public static bool PropertyField(SerializedProperty property, params GUILayoutOption[] options) =>
            EditorGUI.PropertyField(Line, property);

        public static bool PropertyField(
            SerializedProperty property, GUIContent? label, params GUILayoutOption[] options) =>
            EditorGUI.PropertyField(Line, property, label);

        public static Object? ObjectField(
            GUIContent label, Object? obj, System.Type objType, bool allowSceneObjects,
            params GUILayoutOption[] options) => EditorScreen.Field(label, obj);

        public static bool Foldout(bool foldout, string content, bool toggleOnLabelClick) =>
            EditorScreen.Field(new GUIContent(content), foldout);

        public static bool Foldout(bool foldout, GUIContent content, bool toggleOnLabelClick) =>
            EditorScreen.Field(content, foldout);

        public static bool Toggle(GUIContent label, bool value, params GUILayoutOption[] options) =>
            EditorScreen.Field(label, value);

        public static bool ToggleLeft(GUIContent label, bool value, params GUILayoutOption[] options) =>
            EditorScreen.Field(label, value);

        public partial class HorizontalScope : GUI.Scope
        {
            public HorizontalScope(params GUILayoutOption[] options) => EditorScreen.Open("horizontal group");

            public HorizontalScope(GUIStyle style, params GUILayoutOption[] options)
                : this(options)
            {
            }

            protected override void CloseScope() => EditorScreen.Close("horizontal group");
        }

        public partial class VerticalScope : GUI.Scope
        {
            public VerticalScope(params GUILayoutOption[] options) => EditorScreen.Open("vertical group");

            public VerticalScope(GUIStyle style, params GUILayoutOption[] options)
                : this(options)
            {
            }

            protected override void CloseScope() => EditorScreen.Close("vertical group");
        }

        public partial class ScrollViewScope : GUI.Scope
        {
            public ScrollViewScope(Vector2 scrollPosition, params GUILayoutOption[] options)
            {
                this.scrollPosition = scrollPosition;
                EditorScreen.Open("scroll view");
            }

            public Vector2 scrollPosition { get; protected set; }

            protected override void CloseScope() => EditorScreen.Close("scroll view");
        }
    }
}
