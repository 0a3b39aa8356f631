using System;
using System.Collections.Generic;
using System.Linq;
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
}
