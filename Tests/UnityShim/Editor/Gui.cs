using System;
using System.Collections.Generic;
using System.Linq;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

namespace UnityEngine
{
    public partial class GUI
    {
        public static bool enabled { get; set; } = true;
        public static bool changed { get; set; }
        public static Color color { get; set; } = Color.white;
        public static Color contentColor { get; set; } = Color.white;

        public static void Label(Rect position, string text) => EditorScreen.Add(DrawnKind.Label, text);
        public static void Label(Rect position, GUIContent content, GUIStyle style) =>
            EditorScreen.Add(DrawnKind.Label, content.text, "", content.tooltip);
        public static bool Button(Rect position, string text) => EditorScreen.Button(new GUIContent(text));

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
        public static void Label(string text, GUIStyle style, params GUILayoutOption[] options) =>
            EditorScreen.Add(DrawnKind.Label, text);

        public static bool Button(string text, params GUILayoutOption[] options) =>
            EditorScreen.Button(new GUIContent(text));
        public static bool Button(GUIContent content, params GUILayoutOption[] options) =>
            EditorScreen.Button(content);
        public static bool Button(string text, GUIStyle style, params GUILayoutOption[] options) =>
            EditorScreen.Button(new GUIContent(text));
        public static bool Button(GUIContent content, GUIStyle style, params GUILayoutOption[] options) =>
            EditorScreen.Button(content);

        public static void FlexibleSpace()
        {
        }

        public static GUILayoutOption Width(float width) => new GUILayoutOption();

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

    public enum ScaleMode
    {
        StretchToFill = 0,
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
    public sealed partial class EditorGUILayout
    {
        private static readonly Rect Line = new Rect(0f, 0f, 400f, 18f);

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
        public static void LabelField(string label, GUIStyle style, params GUILayoutOption[] options) =>
            EditorScreen.Add(DrawnKind.Label, label);
        public static void LabelField(string label, string label2, params GUILayoutOption[] options) =>
            EditorScreen.Add(DrawnKind.Label, label, label2);
        public static void LabelField(string label, string label2, GUIStyle style, params GUILayoutOption[] options) =>
            EditorScreen.Add(DrawnKind.Label, label, label2);

        public static void HelpBox(string message, MessageType type) =>
            EditorScreen.Add(DrawnKind.Help, message, type.ToString());

        public static void Space()
        {
        }

        public static void Space(float width)
        {
        }

        public static Rect GetControlRect(params GUILayoutOption[] options) => Line;

        public static Rect GetControlRect(bool hasLabel, float height, params GUILayoutOption[] options) =>
            new Rect(Line.x, Line.y, Line.width, height);

        public static bool PropertyField(SerializedProperty property, params GUILayoutOption[] options) =>
            EditorGUI.PropertyField(Line, property);

        public static bool PropertyField(
            SerializedProperty property, GUIContent? label, params GUILayoutOption[] options) =>
            EditorGUI.PropertyField(Line, property, label);

        public static Object? ObjectField(
            GUIContent label, Object? obj, System.Type objType, bool allowSceneObjects,
            params GUILayoutOption[] options) => EditorScreen.Field(label, obj);

        public static bool Foldout(bool foldout, GUIContent content, bool toggleOnLabelClick) =>
            EditorScreen.Field(content, foldout);

        public static bool Toggle(GUIContent label, bool value, params GUILayoutOption[] options) =>
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

    public sealed partial class EditorGUIUtility : GUIUtility
    {
        public static float pixelsPerPoint => WindowHost.PixelsPerPoint;

        public static bool editingTextField { get; set; }

        public static float singleLineHeight => 18f;
        public static float standardVerticalSpacing => 2f;
        public static float labelWidth { get; set; } = 150f;
        public static bool isProSkin => EditorSession.DarkSkin;

        public static void PingObject(Object? obj) => EditorSession.Pinged = obj;
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

    public sealed partial class ObjectNames
    {
        public static string NicifyVariableName(string name) =>
            System.Text.RegularExpressions.Regex.Replace(name, "(?<=[a-z])(?=[A-Z])", " ");
    }

    public sealed partial class EditorStyles
    {
        public static GUIStyle label { get; } = "Label";
        public static GUIStyle boldLabel { get; } = "BoldLabel";
        public static GUIStyle miniLabel { get; } = "MiniLabel";
        public static GUIStyle miniButton { get; } = "MiniButton";
        public static GUIStyle wordWrappedLabel { get; } = "WordWrappedLabel";
        public static GUIStyle wordWrappedMiniLabel { get; } = "WordWrappedMiniLabel";
        public static GUIStyle toolbar { get; } = "Toolbar";
        public static GUIStyle toolbarButton { get; } = "ToolbarButton";
    }
}

namespace UnityEditor.IMGUI.Controls
{
    public partial class AdvancedDropdownState
    {
    }

    public partial class AdvancedDropdownItem
    {
        private readonly List<AdvancedDropdownItem> below = new List<AdvancedDropdownItem>();

        public AdvancedDropdownItem(string name) => this.name = name;

        public string name { get; set; }

        public IEnumerable<AdvancedDropdownItem> children => below;

        public void AddChild(AdvancedDropdownItem child) => below.Add(child);
    }

    public abstract partial class AdvancedDropdown
    {
        protected AdvancedDropdown(AdvancedDropdownState state)
        {
        }

        /// <summary>The list that was shown last. Tests choose an entry from it.</summary>
        internal static AdvancedDropdown? Shown { get; private set; }

        protected Vector2 minimumSize { get; set; }

        public void Show(Rect rect) => Shown = this;

        internal void Pick(string name) => ItemSelected(BuildRoot().children.First(item => item.name == name));

        protected abstract AdvancedDropdownItem BuildRoot();

        protected virtual void ItemSelected(AdvancedDropdownItem item)
        {
        }
    }
}
