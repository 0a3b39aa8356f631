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

namespace HaptoFlow.EditorTests
{
    /// <summary>The page of components calls fields what the Inspector calls them, so that a reader finds them.</summary>
    public sealed class FieldNameTests : EditorTest
    {
        // Words in italics that are no fields of the section's own Inspector.
        private static readonly string[] Elsewhere = { "Preview" };

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

        private HashSet<string> ShownBy(Type type)
        {
            UnityEngine.Object target = typeof(Component).IsAssignableFrom(type)
                ? World.AddComponent(Make("Owner"), type)
                : (UnityEngine.Object)typeof(ScriptableObject).GetMethod(nameof(ScriptableObject.CreateInstance))!
                    .MakeGenericMethod(type).Invoke(null, null)!;
            var editor = UnityEditor.Editor.CreateEditor(target);
            // The shim cannot draw every kind of field; the default Inspector shows each by its name in words.
            var shown = editor.GetType() == typeof(UnityEditor.Editor)
                ? new HashSet<string>(FieldsOf(type))
                : new HashSet<string>(EditorScreen.Draw(editor.OnInspectorGUI).Select(item => item.Label));
            // A custom Inspector shows some fields only in some states.
            foreach (Type drawer in typeof(DocumentationMenu).Assembly.GetTypes()
                .Where(each => !each.ContainsGenericParameters))
            {
                const BindingFlags constants = BindingFlags.Static | BindingFlags.NonPublic | BindingFlags.Public;
                shown.UnionWith(drawer.GetFields(constants).SelectMany(field => field.GetValue(null) switch
                {
                    GUIContent single => new[] { single.text },
                    (string Path, GUIContent Label)[] several => several.Select(each => each.Label.text),
                    _ => Array.Empty<string>(),
                }));
            }
            shown.UnionWith(HelpTests.Assemblies.Append(typeof(HapticEngine).Assembly).SelectMany(each => each.GetTypes())
                .Where(each => each.IsEnum).SelectMany(Enum.GetNames).Select(InWords));
            shown.UnionWith(Elsewhere);
            return shown;
        }

        /// <summary>The serialised fields of a type, of its bases and of the serialisable types in it, in words.</summary>
        private static IEnumerable<string> FieldsOf(Type? type) => type == null
            ? Array.Empty<string>()
            : FieldsOf(type.BaseType).Concat(type
            .GetFields(BindingFlags.Instance | BindingFlags.NonPublic | BindingFlags.DeclaredOnly)
            .Where(field => field.GetCustomAttribute<SerializeField>() != null)
            .SelectMany(field => IsDrawnInside(field.FieldType) ? FieldsOf(field.FieldType).Append(NameOf(field))
                : new[] { NameOf(field) }));

        /// <summary>True for a serialisable type of the package. A field that names another object shows the name only,
        /// and objects name each other in circles.</summary>
        private static bool IsDrawnInside(Type type) =>
            HelpTests.Assemblies.Contains(type.Assembly) && !type.IsEnum && !typeof(UnityEngine.Object).IsAssignableFrom(type);

        private static string NameOf(FieldInfo field) =>
            char.ToUpperInvariant(field.Name[0]) + InWords(field.Name.Substring(1));

        private static string InWords(string name) => Regex.Replace(name, "(?<=[a-z])(?=[A-Z])", " ");
    }
}
