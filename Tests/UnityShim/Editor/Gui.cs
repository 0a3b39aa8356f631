using System;
using UnityShim;

namespace UnityEngine
{
    public partial class GUI
    {
        public static bool enabled { get; set; } = true;
        public static bool changed { get; set; }
        public static Color color { get; set; } = Color.white;
        public static Color contentColor { get; set; } = Color.white;
        public static Color backgroundColor { get; set; } = Color.white;

        public static void Label(Rect position, string text) => EditorScreen.Add(DrawnKind.Label, text);
        public static void Label(Rect position, string text, GUIStyle style) => Label(position, text);
        public static void Label(Rect position, GUIContent content, GUIStyle style) =>
            EditorScreen.Add(DrawnKind.Label, content.text, "", content.tooltip);
        public static bool Button(Rect position, string text) => EditorScreen.Button(new GUIContent(text));
        public static bool Button(Rect position, GUIContent content) => EditorScreen.Button(content);
        public static bool Button(Rect position, GUIContent content, GUIStyle style) => EditorScreen.Button(content);

        public abstract class Scope : IDisposable
        {
            private bool closed;

            public void Dispose()
            {
                if (!closed)
                {
                    closed = true;
                    CloseScope();
                }
            }

            protected abstract void CloseScope();
        }
    }

    public partial class GUILayout
    {
        public static void Label(string text, params GUILayoutOption[] options) =>
            EditorScreen.Add(DrawnKind.Label, text);
        public static void Label(GUIContent content, params GUILayoutOption[] options) =>
            EditorScreen.Add(DrawnKind.Label, content.text, "", content.tooltip);
        public static void Label(string text, GUIStyle style, params GUILayoutOption[] options) =>
            EditorScreen.Add(DrawnKind.Label, text);
        public static void Label(GUIContent content, GUIStyle style, params GUILayoutOption[] options) =>
            EditorScreen.Add(DrawnKind.Label, content.text, "", content.tooltip);

        public static bool Button(string text, params GUILayoutOption[] options) =>
            EditorScreen.Button(new GUIContent(text));
        public static bool Button(GUIContent content, params GUILayoutOption[] options) =>
            EditorScreen.Button(content);
        public static bool Button(string text, GUIStyle style, params GUILayoutOption[] options) =>
            EditorScreen.Button(new GUIContent(text));
        public static bool Button(GUIContent content, GUIStyle style, params GUILayoutOption[] options) =>
            EditorScreen.Button(content);

        public static void Space(float pixels)
        {
        }

        public static void FlexibleSpace()
        {
        }

        public static GUILayoutOption Width(float width) => new GUILayoutOption();
        public static GUILayoutOption MinWidth(float minWidth) => new GUILayoutOption();
        public static GUILayoutOption MaxWidth(float maxWidth) => new GUILayoutOption();
        public static GUILayoutOption Height(float height) => new GUILayoutOption();
        public static GUILayoutOption MinHeight(float minHeight) => new GUILayoutOption();
        public static GUILayoutOption ExpandWidth(bool expand) => new GUILayoutOption();
        public static GUILayoutOption ExpandHeight(bool expand) => new GUILayoutOption();
    }
}
