using System;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

namespace UnityEngine
{
    public enum ScaleMode
    {
        StretchToFill = 0,
        ScaleAndCrop = 1,
        ScaleToFit = 2,
    }

    public partial class GUI
    {
        public static void DrawTexture(Rect position, Texture image, ScaleMode scaleMode) =>
            ScreenPaint.Add(nameof(DrawTexture), position, color, "", image as Texture2D);

        public static void DrawTexture(Rect position, Texture image, ScaleMode scaleMode, bool alphaBlend,
            float imageAspect, Color color, float borderWidth, float borderRadius) =>
            ScreenPaint.Add(nameof(DrawTexture), position, color, "", image as Texture2D);

        public static void BeginClip(Rect position, Vector2 scrollOffset, Vector2 renderOffset, bool resetOffset) =>
            EditorScreen.Open("clip");

        public static void EndClip() => EditorScreen.Close("clip");

        public partial class ScrollViewScope : Scope
        {
            public ScrollViewScope(Rect position, Vector2 scrollPosition, Rect viewRect)
            {
                this.scrollPosition = scrollPosition;
                EditorScreen.Open("scroll view");
            }

            public Vector2 scrollPosition { get; private set; }

            protected override void CloseScope() => EditorScreen.Close("scroll view");
        }
    }

    public partial class GUILayout
    {
        public static bool Toggle(bool value, GUIContent content, params GUILayoutOption[] options) =>
            EditorScreen.Field(content, value);

        /// <summary>Draws a toolbar whose buttons tests press by their captions.</summary>
        public static int Toolbar(int selected, GUIContent[] contents, params GUILayoutOption[] options)
        {
            int chosen = selected;
            for (int index = 0; index < contents.Length; ++index)
            {
                chosen = EditorScreen.Button(contents[index]) ? index : chosen;
            }
            return chosen;
        }

        public partial class AreaScope : GUI.Scope
        {
            public AreaScope(Rect screenRect) => EditorScreen.Open("area");

            protected override void CloseScope() => EditorScreen.Close("area");
        }
    }

    public partial class GUIUtility
    {
        public static int hotControl { get; set; }

        public static int keyboardControl { get; set; }

        public static int GetControlID(int hint, FocusType focusType, Rect rect) => hint | 1;
    }
}

namespace UnityEditor
{
    public sealed partial class EditorGUI
    {
        public static bool actionKey => Event.current.control;
    }

    public sealed partial class EditorGUILayout
    {
        public static float Slider(GUIContent label, float value, float leftValue, float rightValue,
            params GUILayoutOption[] options) => Mathf.Clamp(EditorScreen.Field(label, value), leftValue, rightValue);

        public static int Popup(
            GUIContent label, int selectedIndex, string[] displayedOptions, params GUILayoutOption[] options) =>
            EditorScreen.Field(label, selectedIndex,
                selectedIndex >= 0 && selectedIndex < displayedOptions.Length ? displayedOptions[selectedIndex] : "");

        public static float FloatField(GUIContent label, float value, params GUILayoutOption[] options) =>
            EditorScreen.Field(label, value);

        public static string TextField(GUIContent label, string text, params GUILayoutOption[] options) =>
            EditorScreen.Field(label, text);

        public static int IntField(GUIContent label, int value, params GUILayoutOption[] options) =>
            EditorScreen.Field(label, value);
    }

    public sealed partial class EditorGUIUtility
    {
        public static float pixelsPerPoint => WindowHost.PixelsPerPoint;

        public static bool editingTextField { get; set; }
    }

    public partial class EditorUtility
    {
        public static string SaveFilePanelInProject(
            string title, string defaultName, string extension, string message) =>
            WindowHost.AnswerToSave?.Invoke(defaultName + "." + extension) ?? "";

        public static string OpenFilePanelWithFilters(string title, string directory, string[] filters) =>
            WindowHost.AnswerToOpen?.Invoke() ?? "";

        public static string SaveFilePanel(string title, string directory, string defaultName, string extension) =>
            WindowHost.AnswerToSave?.Invoke(defaultName + "." + extension) ?? "";
    }

    public partial class EditorWindow
    {
        public static bool HasOpenInstances<T>()
            where T : EditorWindow => Open.Exists(window => window is T);

        public void ShowNotification(GUIContent notification) => WindowHost.Notification = notification.text;

        /// <summary>Draws one pass with this event.</summary>
        public bool SendEvent(Event e)
        {
            Event.current = e;
            WindowHost.Draw(this);
            return e.type == EventType.Used;
        }
    }
}
