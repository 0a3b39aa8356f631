#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Draws a <see cref="MaterialDescription"/>, wherever a component has one: labels from a searchable list,
    /// units and what the model says.</summary>
    [CustomPropertyDrawer(typeof(MaterialDescription))]
    internal sealed class MaterialDescriptionDrawer : PropertyDrawer
    {
        private const int FieldRows = 9;
        private const float RemarkWidth = 110f;

        private static readonly GUIContent Label = new GUIContent("Label",
            "What it is made of: a label of the model, kept by its name.");
        private static readonly GUIContent LabelBehind = new GUIContent("Label",
            "Felt where the learnt material cannot be: while it is on its way to the engine, and under another model.");
        private static readonly GUIContent Learnt = new GUIContent("Learnt Material",
            "A Haptic Material that was learnt from a recording, in the place of the label; none for the label.");
        private static readonly GUIContent ItsOwn = new GUIContent("Learnt Material",
            "This asset carries what it was learnt from.");
        private static readonly GUIContent Itself = new GUIContent("this asset");
        private static readonly GUIContent SecondLabel = new GUIContent("Second Label",
            "A label to blend with; none for the first alone.");
        private static readonly GUIContent Blend = new GUIContent("Blend",
            "0: the first label alone. 1: the second alone.");
        private static readonly GUIContent Stiffness = new GUIContent("Stiffness (N/m)",
            "Of the spring model: force a metre of penetration. 0: what the model says of the label.");
        private static readonly GUIContent Effects = new GUIContent("Effects",
            "What the tip feels here. What no surface asks for costs nothing.");
        private static readonly (string Name, GUIContent Content)[] EffectToggles =
        {
            ("texture", new GUIContent("Texture", "The tip feels the material's texture while it slides.")),
            ("impact", new GUIContent("Impact", "The tip feels a landing, as hard as it was fast.")),
            ("edge", new GUIContent("Edge",
                "The tip feels rims, and the crossing to a rougher or smoother label.")),
        };
        private static readonly GUIContent Strength = new GUIContent("Strength",
            "Gain of the output while this is touched, 0 to 1.");

        private static readonly GUIContent FeatureScale = new GUIContent("Feature Scale",
            "The material's features, its ribs included, are this many times as large, 0.25 to 4. The level stays as " +
            "it is.");
        private static readonly GUIContent Tone = new GUIContent("Tone (dB/octave)",
            "The spectrum is tilted about 150 Hz, -12 to 12: above 0 is brighter, below 0 darker.");

        private static float RowHeight =>
            EditorGUIUtility.singleLineHeight + EditorGUIUtility.standardVerticalSpacing;

        public override float GetPropertyHeight(SerializedProperty property, GUIContent label) =>
            RowHeight * (FieldRows + (label.text.Length > 0 ? 1 : 0)) - EditorGUIUtility.standardVerticalSpacing;

        public override void OnGUI(Rect position, SerializedProperty property, GUIContent label)
        {
            var row = new Rect(position.x, position.y, position.width, EditorGUIUtility.singleLineHeight);
            if (label.text.Length > 0)
            {
                EditorGUI.LabelField(row, label.text, EditorStyles.boldLabel);
                row.y += RowHeight;
            }
            SerializedProperty first = property.FindPropertyRelative("label");
            SerializedProperty second = property.FindPropertyRelative("secondLabel");
            bool isLearnt = DrawLearnt(row, property);
            row.y += RowHeight;
            LabelField.Draw(row, first, isLearnt ? LabelBehind : Label, false);
            row.y += RowHeight;
            LabelField.Draw(row, second, SecondLabel, true);
            row.y += RowHeight;
            bool blends = second.hasMultipleDifferentValues || second.stringValue.Length > 0;
            using (new EditorGUI.DisabledScope(!blends))
            {
                EditorGUI.PropertyField(row, property.FindPropertyRelative("blend"), Blend);
            }
            row.y += RowHeight;
            DrawStiffness(row, property.FindPropertyRelative("stiffnessNewtonsPerMetre"), first);
            row.y += RowHeight;
            EditorGUI.PropertyField(row, property.FindPropertyRelative("strength"), Strength);
            row.y += RowHeight;
            EditorGUI.PropertyField(row, property.FindPropertyRelative("featureScale"), FeatureScale);
            row.y += RowHeight;
            EditorGUI.PropertyField(row, property.FindPropertyRelative("toneDbPerOctave"), Tone);
            row.y += RowHeight;
            DrawEffects(row, property);
        }

        /// <returns>Something that was learnt goes before the label.</returns>
        private static bool DrawLearnt(Rect row, SerializedProperty property)
        {
            SerializedProperty learnt = property.FindPropertyRelative("learnt");
            if (property.serializedObject.targetObject is HapticMaterial { IsLearnt: true })
            {
                EditorGUI.LabelField(row, ItsOwn, Itself);
                return true;
            }
            bool isLearnt = !learnt.hasMultipleDifferentValues && learnt.objectReferenceValue != null;
            EditorGUI.PropertyField(row, learnt, Learnt);
            return isLearnt;
        }

        private static void DrawEffects(Rect row, SerializedProperty property)
        {
            Rect rest = EditorGUI.PrefixLabel(row, Effects);
            var place = new Rect(rest.x, rest.y, rest.width / EffectToggles.Length, rest.height);
            foreach ((string name, GUIContent content) in EffectToggles)
            {
                SerializedProperty toggle = property.FindPropertyRelative(name);
                using (var drawn = new EditorGUI.PropertyScope(place, content, toggle))
                using (var changed = new EditorGUI.ChangeCheckScope())
                {
                    bool asked = EditorGUI.ToggleLeft(place, drawn.content, toggle.boolValue);
                    if (changed.changed)
                    {
                        toggle.boolValue = asked;
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
