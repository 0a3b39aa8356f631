#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The Inspector of a map: its rules, what each matches in the open scenes, their problems.</summary>
    [CustomEditor(typeof(HapticMaterialMap))]
    internal sealed class HapticMaterialMapEditor : UnityEditor.Editor
    {
        private const int MaximumNames = 3;
        private static readonly GUIContent Default = new GUIContent("Default");

        private IReadOnlyList<(string Text, MessageType Kind)> lines = Array.Empty<(string, MessageType)>();
        private SceneChanges? changes;
        private bool isStale = true;

        private void OnEnable() => changes = new SceneChanges(MarkStale);

        private void OnDisable() => changes?.Dispose();

        public override void OnInspectorGUI()
        {
            serializedObject.Update();
            EditorGUILayout.PropertyField(serializedObject.FindProperty("rules"));
            EditorGUILayout.PropertyField(serializedObject.FindProperty("defaultMaterial"), Default);
            if (serializedObject.ApplyModifiedProperties())
            {
                MarkStale();
            }
            // Only during layout: the number of lines must not change before Unity draws.
            if (isStale && Event.current.type == EventType.Layout)
            {
                isStale = false;
                lines = LinesOf((HapticMaterialMap)target).ToArray();
            }
            EditorGUILayout.Space();
            EditorGUILayout.LabelField("In the open scenes", EditorStyles.boldLabel);
            foreach ((string text, MessageType kind) in lines)
            {
                EditorGUILayout.HelpBox(text, kind);
            }
        }

        /// <summary>A line for each rule, and one for the default material if there is one.</summary>
        internal static IEnumerable<(string Text, MessageType Kind)> LinesOf(HapticMaterialMap map)
        {
            var maps = new SceneMaps();
            if (!maps.All.Contains(map))
            {
                yield return ("This map is not in use: choose it in Project Settings > HaptoFlow, or in a Haptic " +
                    "Material Map Scope of an open scene.", MessageType.Info);
            }
            ColliderMaterial[] answers = SceneColliders.InScenes().Select(maps.Ask).ToArray();
            for (int rule = 0; rule < map.Rules.Count; ++rule)
            {
                string? problem = RuleCheck.ProblemOf(map, rule);
                string felt = MaterialWords.Of(new MappedPart(
                    map, rule, map.Rules[rule].Material, map.Rules[rule].Mask));
                yield return problem != null
                    ? ($"Rule {rule + 1} ({map.Rules[rule].Describe()}) {problem}.", MessageType.Warning)
                    : ($"Rule {rule + 1}: {map.Rules[rule].Describe()} \u2192 {felt}: {MatchedBy(answers, map, rule)}",
                        MessageType.None);
            }
            if (map.DefaultMaterial != null)
            {
                yield return ($"Default \u2192 {MaterialWords.Of(map.DefaultMaterial)}: {MatchedBy(answers, map, -1)}",
                    MessageType.None);
            }
        }

        private static string MatchedBy(IEnumerable<ColliderMaterial> answers, HapticMaterialMap map, int rule)
        {
            Collider[] matched = answers
                .Where(answer => answer.Surface is null &&
                    answer.ByRules.Parts.Any(part => ReferenceEquals(part.Map, map) && part.Rule == rule))
                .Select(answer => answer.Collider).ToArray();
            return matched.Length == 0 ? "no collider" : MaterialWords.Names(matched, MaximumNames);
        }

        private void MarkStale()
        {
            isStale = true;
            Repaint();
        }
    }

    /// <summary>Draws a rule of a map: its number, its condition, its material, mask and relief.</summary>
    [CustomPropertyDrawer(typeof(HapticMaterialRule))]
    internal sealed class HapticMaterialRuleDrawer : PropertyDrawer
    {
        private const int Rows = 6;

        private static readonly GUIContent Subject = new GUIContent("Looks At");
        private static readonly GUIContent Name = new GUIContent("Name");
        private static readonly GUIContent Material = new GUIContent("Feels Like");

        public override float GetPropertyHeight(SerializedProperty property, GUIContent label) =>
            InspectorRows.Height(Rows + (SubjectOf(property) == MaterialRuleSubject.Submesh ? 1 : 0));

        public override void OnGUI(Rect position, SerializedProperty property, GUIContent label)
        {
            // Read before any field is drawn, so that layout and drawing show the same fields.
            MaterialRuleSubject subject = SubjectOf(property);
            var rows = new InspectorRows(position, property);
            EditorGUI.LabelField(rows.Next(), Title(property), EditorStyles.boldLabel);
            rows.Field("subject", Subject);
            DrawCondition(rows, property, subject);
            rows.Field("material", Material);
            rows.Field("mask");
            rows.Field("relief");
        }

        private static MaterialRuleSubject SubjectOf(SerializedProperty property) =>
            (MaterialRuleSubject)property.FindPropertyRelative("subject").enumValueIndex;

        private static string Title(SerializedProperty property)
        {
            string path = property.propertyPath;
            int open = path.LastIndexOf('[');
            return open >= 0 && int.TryParse(path.Substring(open + 1, path.Length - open - 2), out int index)
                ? $"Rule {index + 1}"
                : "Rule";
        }

        private static void DrawCondition(InspectorRows rows, SerializedProperty property, MaterialRuleSubject subject)
        {
            switch (subject)
            {
                case MaterialRuleSubject.Tag:
                    DrawTag(rows.Next(), property.FindPropertyRelative("tag"));
                    break;
                case MaterialRuleSubject.Layer:
                    DrawLayer(rows.Next(), property.FindPropertyRelative("layer"));
                    break;
                case MaterialRuleSubject.PhysicsMaterial:
                    rows.Field("physicsMaterial");
                    break;
                case MaterialRuleSubject.RendererMaterial:
                    rows.Field("rendererMaterial");
                    break;
                case MaterialRuleSubject.TerrainLayer:
                    rows.Field("terrainLayer");
                    break;
                case MaterialRuleSubject.Submesh:
                    rows.Field("mesh");
                    rows.Field("submesh");
                    break;
                default:
                    rows.Field("namePattern", Name);
                    break;
            }
        }

        private static void DrawTag(Rect row, SerializedProperty tag)
        {
            using var drawn = new EditorGUI.PropertyScope(row, null, tag);
            using var changed = new EditorGUI.ChangeCheckScope();
            string chosen = EditorGUI.TagField(row, drawn.content, tag.stringValue);
            if (changed.changed)
            {
                tag.stringValue = chosen;
            }
        }

        private static void DrawLayer(Rect row, SerializedProperty layer)
        {
            using var drawn = new EditorGUI.PropertyScope(row, null, layer);
            using var changed = new EditorGUI.ChangeCheckScope();
            int chosen = EditorGUI.LayerField(row, drawn.content, layer.intValue);
            if (changed.changed)
            {
                layer.intValue = chosen;
            }
        }
    }
}
