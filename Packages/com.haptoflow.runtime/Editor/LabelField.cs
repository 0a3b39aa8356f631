#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using HaptoFlow.Model;
using UnityEditor;
using UnityEditor.IMGUI.Controls;
using UnityEngine;
using Object = UnityEngine.Object;

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

    /// <summary>A searchable list of labels.</summary>
    internal sealed class LabelDropdown : AdvancedDropdown
    {
        private const float MinimumWidth = 200f;
        private const float MinimumHeight = 280f;

        private readonly IReadOnlyList<LabelOption> options;
        private readonly Action<string> choose;

        public LabelDropdown(IReadOnlyList<LabelOption> options, Action<string> choose)
            : base(new AdvancedDropdownState())
        {
            this.options = options;
            this.choose = choose;
            minimumSize = new Vector2(MinimumWidth, MinimumHeight);
        }

        protected override AdvancedDropdownItem BuildRoot()
        {
            var root = new AdvancedDropdownItem("Labels");
            foreach (LabelOption option in options)
            {
                root.AddChild(new Item(option));
            }
            return root;
        }

        protected override void ItemSelected(AdvancedDropdownItem item)
        {
            if (item is Item chosen)
            {
                choose(chosen.Label);
            }
        }

        private sealed class Item : AdvancedDropdownItem
        {
            public Item(LabelOption option)
                : base(option.Text) => Label = option.Label;

            public string Label { get; }
        }
    }

    /// <summary>An entry in the dropdown list of a label.</summary>
    /// <param name="Label">The label that the entry chooses; empty for none.</param>
    internal sealed record LabelOption(string Text, string Label);

    internal static class LabelOptions
    {
        /// <summary>The entries in this order: the current name if the model does not have it, labels with similar
        /// names, none if that is allowed, and all labels sorted by name.</summary>
        public static IReadOnlyList<LabelOption> For(LabelCatalog catalog, string current, bool canBeEmpty)
        {
            var options = new List<LabelOption>();
            if (catalog.IsUnknown(current))
            {
                options.Add(new LabelOption(catalog.TextOf(current), current));
                options.AddRange(catalog.Names.NearMatches(current)
                    .Select(near => new LabelOption($"{near} (near \"{current}\")", near)));
            }
            if (canBeEmpty)
            {
                options.Add(new LabelOption(catalog.TextOf(""), ""));
            }
            options.AddRange(catalog.Names.All
                .OrderBy(name => name, StringComparer.OrdinalIgnoreCase)
                .Select(name => new LabelOption(name, name)));
            return options;
        }
    }

    /// <summary>The labels that can be chosen: those of the project's model, or of the package's model if the project
    /// names none. They are read again when the model changes. Main thread.</summary>
    internal sealed class LabelCatalog
    {
        private static LabelCatalog? current;

        private readonly byte[] file;
        private readonly Dictionary<string, string> texts = new Dictionary<string, string>(StringComparer.Ordinal);
        private readonly Dictionary<string, string> stiffness =
            new Dictionary<string, string>(LabelSpelling.Same);

        private LabelCatalog(byte[] file, HapticModelAsset? model)
        {
            this.file = file;
            IReadOnlyList<HapticLabel> labels = LabelsOf(model);
            Names = new LabelNames(labels.Select(label => label.Name));
            foreach (HapticLabel label in labels)
            {
                stiffness[label.Name] = string.Format(
                    CultureInfo.InvariantCulture, "0: the model's {0:0}", label.StiffnessNewtonsPerMetre);
            }
        }

        /// <summary>The current labels; empty when the project has no usable model.</summary>
        public static LabelCatalog Current
        {
            get
            {
                HapticModelAsset? model = ModelInUse();
                byte[] file = model != null ? model.File : Array.Empty<byte>();
                if (current == null || !ReferenceEquals(current.file, file))
                {
                    current = new LabelCatalog(file, model);
                }
                return current;
            }
        }

        public LabelNames Names { get; }

        /// <summary>Whether the model lacks a label of this name. False when there is no model.</summary>
        public bool IsUnknown(string name) =>
            name.Length > 0 && Names.All.Count > 0 && !Names.TryFind(name, out _);

        /// <summary>The name, with a remark if the model does not have it; "none" for an empty name.</summary>
        public string TextOf(string name)
        {
            if (!texts.TryGetValue(name, out string text))
            {
                text = name.Length == 0 ? "none" : IsUnknown(name) ? name + " (not in model)" : name;
                texts[name] = text;
            }
            return text;
        }

        /// <summary>The stiffness that 0 stands for, as text; empty for an unknown label.</summary>
        public string StiffnessRemark(string name) =>
            stiffness.TryGetValue(name, out string remark) ? remark : "";

        /// <summary>The project's model, else the package's own; null when neither exists.</summary>
        public static HapticModelAsset? ModelInUse()
        {
            HaptoFlowSettings? settings = ProjectSettingsAsset.Find();
            HapticModelAsset? chosen = settings != null ? settings.Model : null;
            return chosen != null ? chosen : ProjectSettingsAsset.DefaultModel();
        }

        private static IReadOnlyList<HapticLabel> LabelsOf(HapticModelAsset? model)
        {
            try
            {
                return model != null ? model.Header.Labels : Array.Empty<HapticLabel>();
            }
            catch (HaptoFlowException)
            {
                // The model's Inspector and the scene check report the problem.
                return Array.Empty<HapticLabel>();
            }
        }
    }
}
