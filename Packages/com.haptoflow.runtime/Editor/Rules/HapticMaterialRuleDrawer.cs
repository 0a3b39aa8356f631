#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Draws a rule of a map: its number, its condition, its material and mask.</summary>
    [CustomPropertyDrawer(typeof(HapticMaterialRule))]
    internal sealed class HapticMaterialRuleDrawer : PropertyDrawer
    {
        private const int Rows = 5;

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
        }

        private static MaterialRuleSubject SubjectOf(SerializedProperty property) =>
            (MaterialRuleSubject)property.FindPropertyRelative("subject").enumValueIndex;

        /// <summary>The title, for example "Rule 3".</summary>
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
