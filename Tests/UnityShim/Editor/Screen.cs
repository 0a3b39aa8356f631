using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using UnityEditor;
using UnityEngine;

namespace UnityShim
{
    public enum DrawnKind
    {
        Label,
        Help,
        Field,
        Button,
        Bar,
    }

    /// <summary>A control or text that editor code drew.</summary>
    public readonly struct Drawn
    {
        public Drawn(DrawnKind kind, string label, string value, string tooltip, bool enabled)
        {
            Kind = kind;
            Label = label;
            Value = value;
            Tooltip = tooltip;
            Enabled = enabled;
        }

        public DrawnKind Kind { get; }
        public string Label { get; }
        public string Value { get; }
        public string Tooltip { get; }
        public bool Enabled { get; }

        public override string ToString() => $"{Kind}: {Label}{(Value.Length > 0 ? " = " + Value : "")}";
    }

    /// <summary>What editor code draws, kept as text, and the user's hand: which button is pressed, what is entered.
    /// </summary>
    public static class EditorScreen
    {
        private static readonly List<Drawn> Items = new List<Drawn>();
        private static readonly List<string> Presses = new List<string>();
        private static readonly Dictionary<string, object?> Entries = new Dictionary<string, object?>();
        private static readonly Stack<string> Groups = new Stack<string>();
        private static bool acts;

        /// <summary>The next drawing presses this button.</summary>
        public static void Press(string caption) => Presses.Add(caption);

        /// <summary>The next drawing enters this into the field of this label.</summary>
        public static void Enter(string label, object? value) => Entries[label] = value;

        /// <summary>What Unity does with an event: a pass that lays controls out, then one that draws or acts. Presses
        /// and entries that found nothing to act on, groups that were not closed, and controls that nobody laid out
        /// are errors.</summary>
        public static IReadOnlyList<Drawn> Draw(Action draw)
        {
            Event present = Event.current;
            try
            {
                Event.current = new Event { type = EventType.Layout };
                Pass(draw, false);
                int laidOut = Items.Count;
                Event.current = present.type == EventType.Ignore ? new Event { type = EventType.Repaint } : present;
                Pass(draw, true);
                Expect(Items.Count <= laidOut, $"{Items.Count} controls were drawn and {laidOut} laid out");
                Expect(Presses.Count == 0, "no such enabled button: " + string.Join(", ", Presses));
                Expect(Entries.Count == 0, "no such enabled field: " + string.Join(", ", Entries.Keys));
                return Items.ToList();
            }
            finally
            {
                Event.current = present;
                Presses.Clear();
                Entries.Clear();
            }
        }

        internal static void Add(DrawnKind kind, string label, string value = "", string tooltip = "") =>
            Items.Add(new Drawn(kind, label, value, tooltip, GUI.enabled));

        internal static bool Button(GUIContent content)
        {
            Add(DrawnKind.Button, content.text, "", content.tooltip);
            return acts && GUI.enabled && Presses.Remove(content.text);
        }

        /// <summary>Shows a value and gives back what was entered, or the value.</summary>
        internal static T Field<T>(GUIContent label, T value, string? shown = null)
        {
            Add(DrawnKind.Field, label.text, shown ?? TextOf(value), label.tooltip);
            if (!acts || !GUI.enabled || !Entries.TryGetValue(label.text, out object? entered))
            {
                return value;
            }
            Entries.Remove(label.text);
            GUI.changed = true;
            return (T)entered!;
        }

        internal static void Open(string group) => Groups.Push(group);

        internal static void Close(string group) =>
            Expect(Groups.Count > 0 && Groups.Pop() == group, $"{group} was closed and not open");

        internal static string TextOf(object? value) => value switch
        {
            null => "None",
            UnityEngine.Object thing => thing == null ? "None" : thing.name,
            IFormattable formattable => formattable.ToString(null, System.Globalization.CultureInfo.InvariantCulture),
            _ => value.ToString() ?? "",
        };

        private static void Pass(Action draw, bool withHand)
        {
            Items.Clear();
            ScreenPaint.Clear();
            Groups.Clear();
            GUI.enabled = true;
            GUI.changed = false;
            acts = withHand;
            draw();
            Expect(Groups.Count == 0, "not closed: " + string.Join(", ", Groups));
            Expect(GUI.enabled, "drawing was left disabled");
        }

        private static void Expect(bool holds, string otherwise)
        {
            if (!holds)
            {
                throw new InvalidOperationException(otherwise + "; drawn was:\n" + string.Join("\n", Items));
            }
        }
    }

    /// <summary>One call that drew on the screen without being a control.</summary>
    public readonly struct Painted
    {
        public Painted(string call, Rect place, Color color, string text, Texture2D? image)
        {
            Call = call;
            Place = place;
            Color = color;
            Text = text;
            Image = image;
        }

        /// <summary>Name of the method, for example "DrawRect".</summary>
        public string Call { get; }

        public Rect Place { get; }
        public Color Color { get; }

        /// <summary>Empty for shapes and images.</summary>
        public string Text { get; }

        /// <summary>Null for shapes and texts.</summary>
        public Texture2D? Image { get; }
    }

    /// <summary>Records shapes, texts and images that editor code draws, in the order of the calls.</summary>
    public static class ScreenPaint
    {
        private static readonly List<Painted> Calls = new List<Painted>();

        public static IReadOnlyList<Painted> All => Calls;

        public static void Clear() => Calls.Clear();

        internal static void Add(
            string call, Rect place, Color color, string text = "", Texture2D? image = null) =>
            Calls.Add(new Painted(call, place, color, text, image));
    }

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
            if (SerializedFields.IsNested(property.FieldType) && !isEvent)
            {
                throw new NotSupportedException($"the shim draws no fields of {property.propertyPath}");
            }
            Enter(property, label, property.Boxed);
        }

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
