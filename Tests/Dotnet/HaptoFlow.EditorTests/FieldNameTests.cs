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
    }
}
