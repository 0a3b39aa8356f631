#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Draws one rule of a map: its number, what it looks for, what that feels like.</summary>
    [CustomPropertyDrawer(typeof(HapticMaterialRule))]
    internal sealed class HapticMaterialRuleDrawer : PropertyDrawer
    {
        private const int Rows = 5;

        private static readonly GUIContent Subject = new GUIContent("Looks At",
            "What of an object this rule looks at.");
        private static readonly GUIContent Tag = new GUIContent("Tag", "The Unity tag of the collider's object.");
        private static readonly GUIContent Layer = new GUIContent("Layer", "The layer of the collider's object.");
        private static readonly GUIContent PhysicsMaterial = new GUIContent("Physics Material",
            "The collider's physics material.");
        private static readonly GUIContent RendererMaterial = new GUIContent("Renderer Material",
            "A material of the object's renderer. On a mesh collider each submesh goes by its own; on other " +
            "colliders the first counts.");
        private static readonly GUIContent TerrainLayer = new GUIContent("Terrain Layer",
            "A layer that a terrain is painted with. Layers are mixed as they are painted.");
        private static readonly GUIContent Mesh = new GUIContent("Mesh",
            "The mesh whose submesh counts; empty for every mesh.");
        private static readonly GUIContent Submesh = new GUIContent("Submesh", "Number of the submesh, from 0.");
        private static readonly GUIContent Name = new GUIContent("Name",
            "The name of the collider's object. A * stands for any characters; upper and lower case count alike.");
        private static readonly GUIContent Material = new GUIContent("Feels Like",
            "The material; empty for nothing, and no later rule is asked.");
        private static readonly GUIContent Mask = new GUIContent("Mask",
            "Further materials by a texture, at the place that is touched; empty for none.");

        private static float RowHeight =>
            EditorGUIUtility.singleLineHeight + EditorGUIUtility.standardVerticalSpacing;

        public override float GetPropertyHeight(SerializedProperty property, GUIContent label) =>
            RowHeight * (Rows + (SubjectOf(property) == MaterialRuleSubject.Submesh ? 1 : 0)) -
            EditorGUIUtility.standardVerticalSpacing;

        public override void OnGUI(Rect position, SerializedProperty property, GUIContent label)
        {
            // Decided before it is changed: nothing is drawn that was not laid out.
            MaterialRuleSubject subject = SubjectOf(property);
            var row = new Rect(position.x, position.y, position.width, EditorGUIUtility.singleLineHeight);
            EditorGUI.LabelField(row, Title(property), EditorStyles.boldLabel);
            row.y += RowHeight;
            EditorGUI.PropertyField(row, property.FindPropertyRelative("subject"), Subject);
            row.y += RowHeight;
            row = DrawWanted(row, property, subject);
            EditorGUI.PropertyField(row, property.FindPropertyRelative("material"), Material);
            row.y += RowHeight;
            EditorGUI.PropertyField(row, property.FindPropertyRelative("mask"), Mask);
        }

        private static MaterialRuleSubject SubjectOf(SerializedProperty property) =>
            (MaterialRuleSubject)property.FindPropertyRelative("subject").enumValueIndex;

        /// <summary>"Rule 3": as the answers name it.</summary>
        private static string Title(SerializedProperty property)
        {
            string path = property.propertyPath;
            int open = path.LastIndexOf('[');
            return open >= 0 && int.TryParse(path.Substring(open + 1, path.Length - open - 2), out int index)
                ? $"Rule {index + 1}"
                : "Rule";
        }

        private static Rect DrawWanted(Rect row, SerializedProperty property, MaterialRuleSubject subject)
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
                    row.y += RowHeight;
                    EditorGUI.PropertyField(row, property.FindPropertyRelative("submesh"), Submesh);
                    break;
                default:
                    EditorGUI.PropertyField(row, property.FindPropertyRelative("namePattern"), Name);
                    break;
            }
            row.y += RowHeight;
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
