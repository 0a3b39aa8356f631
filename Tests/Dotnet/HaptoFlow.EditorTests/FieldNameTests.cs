using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Reflection;
using System.Text.RegularExpressions;
using HaptoFlow.Editor;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEditor;
using UnityEngine;
using UnityShim;
using SerializedFields = UnityShim.SerializedFields;

namespace HaptoFlow.EditorTests
{
    /// <summary>The page of components calls fields what the Inspector calls them, so that a reader finds them.</summary>
    public sealed class FieldNameTests : EditorTest
    {
        // Words in italics that are no fields of the section's own Inspector.
        private static readonly string[] Elsewhere = { "Hand", "Mask", "Preview", "Tip Force" };

        private static IEnumerable<TestCaseData> Sections()
        {
            string[] parts = Regex.Split(
                File.ReadAllText(RepositoryFiles.In("Documentation~", "components.md")), "^## ", RegexOptions.Multiline);
            foreach (Type type in HelpTests.Assemblies.SelectMany(each => each.GetTypes()).Where(each => !each.IsAbstract))
            {
                string? page = type.GetCustomAttribute<HelpPageAttribute>(false)?.Page;
                string? text = parts.FirstOrDefault(part => page == HelpPages.Components + HelpTests.AnchorOf(part.Split('\n')[0]));
                if (text != null)
                {
                    yield return new TestCaseData(type, text).SetName("{m}(" + type.Name + ")");
                }
            }
        }

        [TestCaseSource(nameof(Sections))]
        public void EveryFieldNamedOnThePageIsShownUnderThatName(Type type, string text)
        {
            HashSet<string> shown = ShownBy(type);
            IEnumerable<string> named = Regex.Matches(text, @"(?<![*\w])\*([A-Z][^*\n]*(?:\n[^*\n]+)?)\*(?!\*)")
                .Select(match => Regex.Replace(match.Groups[1].Value, @"\s+", " ")).Distinct();
            Assert.That(named.Where(name => !shown.Contains(name)), Is.Empty,
                "shown: " + string.Join(", ", shown.OrderBy(each => each)));
        }

        /// <summary>A tooltip that an Inspector wrote itself would stand twice, and soon in other words.</summary>
        [TestCaseSource(nameof(Inspected))]
        public void EveryFieldIsShownWithTheTooltipThatIsWrittenOnIt(Type type)
        {
            HashSet<string> written = TooltipsOf(type).ToHashSet();
            Drawn[] fields = InEveryState(type).Where(item => item.Kind == DrawnKind.Field).ToArray();
            Assert.That(fields, Is.Not.Empty);
            Assert.That(fields.Where(item => !written.Contains(item.Tooltip)).Select(item => $"{item.Label}: {item.Tooltip}"),
                Is.Empty);
        }

        /// <summary>The components and assets whose fields a custom Inspector draws.</summary>
        private static IEnumerable<TestCaseData> Inspected() =>
            new[]
            {
                typeof(HapticStylus), typeof(HapticSurface), typeof(HapticMaterial), typeof(HapticOutput), typeof(AutoOutput),
                typeof(HapticMaterialMap), typeof(HapticMaskMap), typeof(HaptoFlowSettings),
            }.Select(type => new TestCaseData(type).SetName("{m}(" + type.Name + ")"));

        private HashSet<string> ShownBy(Type type)
        {
            // The shim cannot draw every kind of field; the default Inspector shows each by its name in words.
            var shown = UnityEditor.Editor.CreateEditor(New(type)).GetType() == typeof(UnityEditor.Editor)
                ? new HashSet<string>(FieldsOf(type))
                : new HashSet<string>(InEveryState(type).Select(item => item.Label));
            // Buttons are shown in some states only.
            foreach (Type drawer in typeof(DocumentationMenu).Assembly.GetTypes()
                .Where(each => !each.ContainsGenericParameters))
            {
                const BindingFlags constants = BindingFlags.Static | BindingFlags.NonPublic | BindingFlags.Public;
                shown.UnionWith(drawer.GetFields(constants).Select(field => field.GetValue(null)).OfType<GUIContent>()
                    .Select(content => content.text));
            }
            shown.UnionWith(HelpTests.Assemblies.Append(typeof(HapticEngine).Assembly).SelectMany(each => each.GetTypes())
                .Where(each => each.IsEnum).SelectMany(Enum.GetNames).Select(InWords));
            shown.UnionWith(Elsewhere);
            return shown;
        }

        /// <summary>What an Inspector draws for every value of every choice, because choices show and hide fields.
        /// Lists have an element.</summary>
        private IEnumerable<Drawn> InEveryState(Type type)
        {
            UnityEngine.Object target = New(type);
            foreach (string size in SerializedFields.Leaves(target).Where(path => path.EndsWith(".Array.size")).ToArray())
            {
                SerializedFields.Set(target, size, 1);
            }
            var editor = UnityEditor.Editor.CreateEditor(target);
            var drawn = new List<Drawn>(EditorScreen.Draw(editor.OnInspectorGUI));
            foreach (string path in SerializedFields.Leaves(target).ToArray())
            {
                object? before = SerializedFields.Get(target, path);
                foreach (object value in before is Enum ? Enum.GetValues(before.GetType()) : Array.Empty<object>())
                {
                    SerializedFields.Set(target, path, value);
                    drawn.AddRange(EditorScreen.Draw(editor.OnInspectorGUI));
                }
                SerializedFields.Set(target, path, before);
            }
            return drawn;
        }

        private UnityEngine.Object New(Type type) => typeof(Component).IsAssignableFrom(type)
            ? World.AddComponent(Make("Owner"), type)
            : ScriptableObject.CreateInstance(type);

        private static IEnumerable<string> TooltipsOf(Type? type) => type == null
            ? Array.Empty<string>()
            : TooltipsOf(type.BaseType).Concat(SerialisedFieldsOf(type).SelectMany(field =>
                (IsDrawnInside(InnerOf(field)) ? TooltipsOf(InnerOf(field)) : Array.Empty<string>())
                .Append(field.GetCustomAttribute<TooltipAttribute>()?.tooltip)).OfType<string>());

        /// <summary>The serialised fields of a type, of its bases and of the serialisable types in it, in words.</summary>
        private static IEnumerable<string> FieldsOf(Type? type) => type == null
            ? Array.Empty<string>()
            : FieldsOf(type.BaseType).Concat(SerialisedFieldsOf(type)
            .SelectMany(field => IsDrawnInside(InnerOf(field)) ? FieldsOf(InnerOf(field)).Append(NameOf(field))
                : new[] { NameOf(field) }));

        private static IEnumerable<FieldInfo> SerialisedFieldsOf(Type type) => type
            .GetFields(BindingFlags.Instance | BindingFlags.NonPublic | BindingFlags.DeclaredOnly)
            .Where(field => field.GetCustomAttribute<SerializeField>() != null);

        /// <summary>The type of a field, or of the elements of a list.</summary>
        private static Type InnerOf(FieldInfo field) =>
            field.FieldType.IsGenericType ? field.FieldType.GetGenericArguments()[0] : field.FieldType;

        /// <summary>True for a serialisable type of the package. A field that names another object shows the name only,
        /// and objects name each other in circles.</summary>
        private static bool IsDrawnInside(Type type) =>
            HelpTests.Assemblies.Contains(type.Assembly) && !type.IsEnum && !typeof(UnityEngine.Object).IsAssignableFrom(type);

        private static string NameOf(FieldInfo field) =>
            char.ToUpperInvariant(field.Name[0]) + InWords(field.Name.Substring(1));

        private static string InWords(string name) => Regex.Replace(name, "(?<=[a-z])(?=[A-Z])", " ");
    }
}
