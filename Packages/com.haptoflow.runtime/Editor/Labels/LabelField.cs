#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Draws a field for a label of the model, which is serialised by its name.</summary>
    internal static class LabelField
    {
        private const string SeveralValues = "\u2014";
        private static readonly GUIContent Button = new GUIContent();

        public static void Draw(Rect position, SerializedProperty property, bool canBeEmpty)
        {
            using var scope = new EditorGUI.PropertyScope(position, null, property);
            Rect field = EditorGUI.PrefixLabel(position, scope.content);
            LabelCatalog catalog = LabelCatalog.Current;
            bool several = property.hasMultipleDifferentValues;
            string present = several ? "" : property.stringValue;
            Button.text = several ? SeveralValues : catalog.TextOf(present);
            Button.tooltip = catalog.IsUnknown(present)
                ? "The model does not have this label. The list offers similar ones."
                : scope.content.tooltip;
            if (EditorGUI.DropdownButton(field, Button, FocusType.Keyboard))
            {
                Open(field, property, catalog, present, canBeEmpty);
            }
        }

        private static void Open(
            Rect field, SerializedProperty property, LabelCatalog catalog, string present, bool canBeEmpty)
        {
            // The user chooses later, when the Inspector's serialised object may no longer exist.
            Object[] targets = property.serializedObject.targetObjects;
            string path = property.propertyPath;
            new LabelDropdown(LabelOptions.For(catalog, present, canBeEmpty), name => Write(targets, path, name))
                .Show(field);
        }

        private static void Write(Object[] targets, string path, string name)
        {
            if (System.Array.TrueForAll(targets, target => target != null))
            {
                SerializedFields.Set(targets, path, property => property.stringValue = name);
            }
        }
    }
}
