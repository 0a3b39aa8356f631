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

        private static readonly GUIContent Subject = new GUIContent("Looks At",
            "The rule compares this property of an object.");
        private static readonly GUIContent Tag = new GUIContent("Tag", "The rule matches colliders whose object has " +
            "this Unity tag.");
        private static readonly GUIContent Layer = new GUIContent("Layer", "The rule matches colliders whose object " +
            "is on this layer.");
        private static readonly GUIContent PhysicsMaterial = new GUIContent("Physics Material",
            "The rule matches colliders with this physics material.");
        private static readonly GUIContent RendererMaterial = new GUIContent("Renderer Material",
            "The rule matches this material of the object's renderer. A mesh collider is compared by submesh, any " +
            "other collider by the first material.");
        private static readonly GUIContent TerrainLayer = new GUIContent("Terrain Layer",
            "The rule matches this layer of a terrain. Where several layers are painted, their materials are blended.");
        private static readonly GUIContent Mesh = new GUIContent("Mesh",
            "The rule matches a submesh of this mesh. When it is empty, it matches every mesh.");
        private static readonly GUIContent Submesh = new GUIContent("Submesh", "The rule matches the submesh of this " +
            "number, counted from 0.");
        private static readonly GUIContent Name = new GUIContent("Name",
            "The rule matches colliders whose object has this name. A * stands for any characters; case is ignored.");
        private static readonly GUIContent Material = new GUIContent("Feels Like",
            "Matching objects have this material. When it is empty they are not felt, and no later rule applies.");
        private static readonly GUIContent Mask = new GUIContent("Mask",
            "The mask selects further materials by a texture at the touched point. It may be empty.");

        public override float GetPropertyHeight(SerializedProperty property, GUIContent label) =>
            InspectorRows.Height * (Rows + (SubjectOf(property) == MaterialRuleSubject.Submesh ? 1 : 0)) -
            EditorGUIUtility.standardVerticalSpacing;

        public override void OnGUI(Rect position, SerializedProperty property, GUIContent label)
        {
            // Read before any field is drawn, so that layout and drawing show the same fields.
            MaterialRuleSubject subject = SubjectOf(property);
            var row = new Rect(position.x, position.y, position.width, EditorGUIUtility.singleLineHeight);
            EditorGUI.LabelField(row, Title(property), EditorStyles.boldLabel);
            row.y += InspectorRows.Height;
            EditorGUI.PropertyField(row, property.FindPropertyRelative("subject"), Subject);
            row.y += InspectorRows.Height;
            row = DrawCondition(row, property, subject);
            EditorGUI.PropertyField(row, property.FindPropertyRelative("material"), Material);
            row.y += InspectorRows.Height;
            EditorGUI.PropertyField(row, property.FindPropertyRelative("mask"), Mask);
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

        private static Rect DrawCondition(Rect row, SerializedProperty property, MaterialRuleSubject subject)
        {
            switch (subject)
            {
                case MaterialRuleSubject.Tag:
                    DrawTag(row, property.FindPropertyRelative("tag"));
                    break;
                case MaterialRuleSubject.Layer:
                    DrawLayer(row, property.FindPropertyRelative("layer"));
                    break;
                case MaterialRuleSubject.PhysicsMaterial:
                    EditorGUI.PropertyField(row, property.FindPropertyRelative("physicsMaterial"), PhysicsMaterial);
                    break;
                case MaterialRuleSubject.RendererMaterial:
                    EditorGUI.PropertyField(row, property.FindPropertyRelative("rendererMaterial"), RendererMaterial);
                    break;
                case MaterialRuleSubject.TerrainLayer:
                    EditorGUI.PropertyField(row, property.FindPropertyRelative("terrainLayer"), TerrainLayer);
                    break;
                case MaterialRuleSubject.Submesh:
                    EditorGUI.PropertyField(row, property.FindPropertyRelative("mesh"), Mesh);
                    row.y += InspectorRows.Height;
                    EditorGUI.PropertyField(row, property.FindPropertyRelative("submesh"), Submesh);
                    break;
                default:
                    EditorGUI.PropertyField(row, property.FindPropertyRelative("namePattern"), Name);
                    break;
            }
            row.y += InspectorRows.Height;
            return row;
        }

        private static void DrawTag(Rect row, SerializedProperty tag)
        {
            using var drawn = new EditorGUI.PropertyScope(row, Tag, tag);
            using var changed = new EditorGUI.ChangeCheckScope();
            string chosen = EditorGUI.TagField(row, drawn.content, tag.stringValue);
            if (changed.changed)
            {
                tag.stringValue = chosen;
            }
        }

        private static void DrawLayer(Rect row, SerializedProperty layer)
        {
            using var drawn = new EditorGUI.PropertyScope(row, Layer, layer);
            using var changed = new EditorGUI.ChangeCheckScope();
            int chosen = EditorGUI.LayerField(row, drawn.content, layer.intValue);
            if (changed.changed)
            {
                layer.intValue = chosen;
            }
        }
    }
}
