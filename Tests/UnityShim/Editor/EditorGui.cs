using System;
using System.Collections.Generic;
using UnityEngine;
using UnityShim;

namespace UnityEditor
{
    public enum MessageType
    {
        None = 0,
        Info = 1,
        Warning = 2,
        Error = 3,
    }

    public sealed partial class EditorGUI
    {
        private static readonly Stack<bool> OuterEnabled = new Stack<bool>();
        private static readonly Stack<bool> OuterChanged = new Stack<bool>();

        public static int indentLevel { get; set; }
        public static bool showMixedValue { get; set; }
        public static bool actionKey => Event.current.control;

        public static void BeginDisabledGroup(bool disabled)
        {
            OuterEnabled.Push(GUI.enabled);
            GUI.enabled &= !disabled;
            EditorScreen.Open("disabled group");
        }

        public static void EndDisabledGroup()
        {
            EditorScreen.Close("disabled group");
            GUI.enabled = OuterEnabled.Pop();
        }

        public static void BeginChangeCheck()
        {
            OuterChanged.Push(GUI.changed);
            GUI.changed = false;
            EditorScreen.Open("change check");
        }

        public static bool EndChangeCheck()
        {
            EditorScreen.Close("change check");
            bool changed = GUI.changed;
            GUI.changed |= OuterChanged.Pop();
            return changed;
        }

        public static GUIContent BeginProperty(Rect totalPosition, GUIContent? label, SerializedProperty property)
        {
            EditorScreen.Open("property");
            showMixedValue = property.hasMultipleDifferentValues;
            return new GUIContent(label?.text ?? property.displayName,
                label == null || label.tooltip.Length == 0 ? property.tooltip : label.tooltip);
        }

        public static void EndProperty()
        {
            showMixedValue = false;
            EditorScreen.Close("property");
        }

        public static Rect PrefixLabel(Rect totalPosition, GUIContent label)
        {
            EditorScreen.Add(DrawnKind.Label, label.text, "", label.tooltip);
            return totalPosition;
        }

        public static bool ToggleLeft(Rect position, GUIContent label, bool value) => EditorScreen.Field(label, value);

        public static string TagField(Rect position, GUIContent label, string tag) => EditorScreen.Field(label, tag);

        public static int LayerField(Rect position, GUIContent label, int layer) => EditorScreen.Field(label, layer);

        public static bool DropdownButton(Rect position, GUIContent content, FocusType focusType) =>
            EditorScreen.Button(content);

        public static void LabelField(Rect position, string label) => EditorScreen.Add(DrawnKind.Label, label);
        public static void LabelField(Rect position, string label, GUIStyle style) => LabelField(position, label);
        public static void LabelField(Rect position, GUIContent label, GUIContent label2) =>
            EditorScreen.Add(DrawnKind.Label, label.text, label2.text, label.tooltip);

        public static void HelpBox(Rect position, string message, MessageType type) =>
            EditorScreen.Add(DrawnKind.Help, message, type.ToString());

        public static void ProgressBar(Rect position, float value, string text) =>
            EditorScreen.Add(DrawnKind.Bar, text, EditorScreen.TextOf(value));

        public static void DrawRect(Rect rect, Color color) => ScreenPaint.Add(nameof(DrawRect), rect, color);

        public static bool PropertyField(Rect position, SerializedProperty property) =>
            PropertyField(position, property, null);

        public static bool PropertyField(Rect position, SerializedProperty property, GUIContent? label)
        {
            PropertyScreen.Show(position, property, label ?? new GUIContent(property.displayName, property.tooltip));
            return false;
        }

        public partial struct DisabledScope : IDisposable
        {
            public DisabledScope(bool disabled) => BeginDisabledGroup(disabled);

            public void Dispose() => EndDisabledGroup();
        }

        public partial class ChangeCheckScope : GUI.Scope
        {
            private bool closed;
            private bool found;

            public ChangeCheckScope() => BeginChangeCheck();

            public bool changed
            {
                get
                {
                    if (!closed)
                    {
                        closed = true;
                        found = EndChangeCheck();
                    }
                    return found;
                }
            }

            protected override void CloseScope()
            {
                if (!closed)
                {
                    EndChangeCheck();
                }
            }
        }

        public partial class PropertyScope : GUI.Scope
        {
            public PropertyScope(Rect totalPosition, GUIContent? label, SerializedProperty property) =>
                content = BeginProperty(totalPosition, label, property);

            public GUIContent content { get; protected set; }

            protected override void CloseScope() => EndProperty();
        }

        public partial class IndentLevelScope : GUI.Scope
        {
            public IndentLevelScope()
            {
                ++indentLevel;
                EditorScreen.Open("indent");
            }

            protected override void CloseScope()
            {
                --indentLevel;
                EditorScreen.Close("indent");
            }
        }
    }
}
