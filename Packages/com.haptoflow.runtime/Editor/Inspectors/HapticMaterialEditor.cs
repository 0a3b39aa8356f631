#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The Inspector of a material that surfaces share.</summary>
    [CustomEditor(typeof(HapticMaterial))]
    [CanEditMultipleObjects]
    internal sealed class HapticMaterialEditor : UnityEditor.Editor
    {
        internal static readonly GUIContent Preview = new GUIContent("Preview",
            "Preview opens the Texture Preview with this material, to hear and see it without a headset.");

        private readonly MaterialSummaryView view = new MaterialSummaryView();

        public override void OnInspectorGUI()
        {
            if (targets.Length == 1 && ((HapticMaterial)target).IsLearnt)
            {
                view.Draw(((HapticMaterial)target).Learnt);
                EditorGUILayout.Space();
            }
            Draw(serializedObject);
            if (GUILayout.Button(Preview))
            {
                TexturePreviewWindow.Open(target);
            }
        }

        internal static void Draw(SerializedObject material)
        {
            material.Update();
            EditorGUILayout.PropertyField(material.FindProperty("description"), GUIContent.none);
            material.ApplyModifiedProperties();
        }
    }

    /// <summary>Draws a <see cref="MaterialDescription"/> in any Inspector, with a searchable list of labels, with
    /// units, and with the stiffness of the model.</summary>
    [CustomPropertyDrawer(typeof(MaterialDescription))]
    internal sealed class MaterialDescriptionDrawer : PropertyDrawer
    {
        private const int FieldRows = 9;
        private const float RemarkWidth = 110f;

        private static readonly GUIContent Learnt = new GUIContent("Learnt Material");
        private static readonly GUIContent ItsOwn = new GUIContent("Learnt Material",
            "The learnt material is part of this asset.");
        private static readonly GUIContent Itself = new GUIContent("this asset");
        private static readonly GUIContent Stiffness = new GUIContent("Stiffness (N/m)");
        private static readonly GUIContent Tone = new GUIContent("Tone (dB/octave)");
        private static readonly GUIContent Effects = new GUIContent("Effects",
            "The effects are what the tip feels here. An effect that no surface uses takes no time.");
        private static readonly string[] EffectToggles = { "texture", "impact", "edge" };

        public override float GetPropertyHeight(SerializedProperty property, GUIContent label) =>
            InspectorRows.Height(FieldRows + (label.text.Length > 0 ? 1 : 0));

        public override void OnGUI(Rect position, SerializedProperty property, GUIContent label)
        {
            var rows = new InspectorRows(position, property);
            if (label.text.Length > 0)
            {
                EditorGUI.LabelField(rows.Next(), label.text, EditorStyles.boldLabel);
            }
            SerializedProperty first = property.FindPropertyRelative("label");
            SerializedProperty second = property.FindPropertyRelative("secondLabel");
            DrawLearnt(rows, property);
            LabelField.Draw(rows.Next(), first, false);
            LabelField.Draw(rows.Next(), second, true);
            bool blends = second.hasMultipleDifferentValues || second.stringValue.Length > 0;
            using (new EditorGUI.DisabledScope(!blends))
            {
                rows.Field("blend");
            }
            DrawStiffness(rows.Next(), property.FindPropertyRelative("stiffnessNewtonsPerMetre"), first);
            rows.Field("strength");
            rows.Field("featureScale");
            rows.Field("toneDbPerOctave", Tone);
            DrawEffects(rows.Next(), property);
        }

        private static void DrawLearnt(InspectorRows rows, SerializedProperty property)
        {
            if (property.serializedObject.targetObject is HapticMaterial { IsLearnt: true })
            {
                EditorGUI.LabelField(rows.Next(), ItsOwn, Itself);
                return;
            }
            rows.Field("learnt", Learnt);
        }

        private static void DrawEffects(Rect row, SerializedProperty property)
        {
            Rect rest = EditorGUI.PrefixLabel(row, Effects);
            var place = new Rect(rest.x, rest.y, rest.width / EffectToggles.Length, rest.height);
            foreach (string name in EffectToggles)
            {
                SerializedProperty toggle = property.FindPropertyRelative(name);
                using (var drawn = new EditorGUI.PropertyScope(place, null, toggle))
                using (var changed = new EditorGUI.ChangeCheckScope())
                {
                    bool isOn = EditorGUI.ToggleLeft(place, drawn.content, toggle.boolValue);
                    if (changed.changed)
                    {
                        toggle.boolValue = isOn;
                    }
                }
                place.x += place.width;
            }
        }

        private static void DrawStiffness(Rect row, SerializedProperty stiffness, SerializedProperty label)
        {
            bool ofModel = !stiffness.hasMultipleDifferentValues && stiffness.floatValue.Equals(0f) &&
                !label.hasMultipleDifferentValues;
            string remark = ofModel ? LabelCatalog.Current.StiffnessRemark(label.stringValue) : "";
            Rect field = row;
            if (remark.Length > 0)
            {
                field.width -= RemarkWidth;
                var place = new Rect(field.xMax + 4f, row.y, RemarkWidth - 4f, row.height);
                EditorGUI.LabelField(place, remark, EditorStyles.miniLabel);
            }
            EditorGUI.PropertyField(field, stiffness, Stiffness);
        }
    }
}
