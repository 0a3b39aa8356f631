using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using UnityEditor;
using UnityEngine;

namespace UnityShim
{
    /// <summary>Draws a serialised property with the drawer of its type, or else as a plain field.</summary>
    internal static class PropertyScreen
    {
        private static readonly Lazy<Dictionary<Type, Type>> Drawers = new Lazy<Dictionary<Type, Type>>(FindDrawers);

        public static void Show(Rect position, SerializedProperty property, GUIContent label)
        {
            PropertyDrawer? drawer = DrawerOf(property);
            if (drawer != null)
            {
                drawer.OnGUI(position, property, label);
                return;
            }
            if (property.isArray)
            {
                // The heading of a list shows the tooltip of its field, whatever the label has.
                EditorScreen.Add(DrawnKind.Label, label.text, "", property.tooltip);
                for (int index = 0; index < property.arraySize; ++index)
                {
                    Show(position, property.GetArrayElementAtIndex(index), new GUIContent("Element " + index));
                }
                return;
            }
            bool isEvent = typeof(UnityEngine.Events.UnityEventBase).IsAssignableFrom(property.FieldType);
            if (property.propertyType == SerializedPropertyType.Generic && !isEvent)
            {
                throw new NotSupportedException($"the shim draws no fields of {property.propertyPath}");
            }
            Enter(property, label, property.Boxed);
        }

        public static float HeightOf(SerializedProperty property, GUIContent label) =>
            DrawerOf(property)?.GetPropertyHeight(property, label) ?? EditorGUIUtility.singleLineHeight;

        /// <summary>Shows a value, or "—" if the targets have different ones, and writes an entered value.</summary>
        public static T Enter<T>(SerializedProperty property, GUIContent label, T value)
        {
            var shown = new GUIContent(label.text, label.tooltip.Length > 0 ? label.tooltip : property.tooltip);
            T entered = EditorScreen.Field(shown, value, property.hasMultipleDifferentValues ? "—" : null);
            if (!Equals(entered, value))
            {
                property.Boxed = entered;
            }
            return entered;
        }

        private static PropertyDrawer? DrawerOf(SerializedProperty property)
        {
            if (!Drawers.Value.TryGetValue(property.FieldType, out Type drawer))
            {
                return null;
            }
            return (PropertyDrawer)Activator.CreateInstance(drawer, true);
        }

        private static Dictionary<Type, Type> FindDrawers() => EditorTypes.All
            .SelectMany(type => type.GetCustomAttributes<CustomPropertyDrawer>().Select(found => (type, found)))
            .ToDictionary(entry => entry.found.DrawnType, entry => entry.type);
    }

    /// <summary>Finds types in the code under test.</summary>
    internal static class EditorTypes
    {
        public static IEnumerable<Type> All => AppDomain.CurrentDomain.GetAssemblies()
            .Where(assembly => assembly.GetName().Name!.StartsWith("HaptoFlow", StringComparison.Ordinal))
            .SelectMany(assembly => assembly.GetTypes());
    }
}
