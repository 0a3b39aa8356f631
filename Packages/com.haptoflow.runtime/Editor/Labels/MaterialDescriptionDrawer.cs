#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Draws a <see cref="MaterialDescription"/> in any Inspector, with a searchable list of labels, with
    /// units, and with the stiffness of the model.</summary>
    [CustomPropertyDrawer(typeof(MaterialDescription))]
    internal sealed class MaterialDescriptionDrawer : PropertyDrawer
    {
        private const int FieldRows = 9;
        private const float RemarkWidth = 110f;

        private static readonly GUIContent Label = new GUIContent("Label",
            "The label of the model names the material. It is saved by its name.");
        private static readonly GUIContent LabelBehind = new GUIContent("Label",
            "The label replaces the learnt material where that cannot be used: until the engine has it, and with " +
            "another model.");
        private static readonly GUIContent Learnt = new GUIContent("Learnt Material",
            "The learnt material is a Haptic Material learnt from a recording. It replaces the label. It may be " +
            "empty.");
        private static readonly GUIContent ItsOwn = new GUIContent("Learnt Material",
            "The learnt material is part of this asset.");
        private static readonly GUIContent Itself = new GUIContent("this asset");
        private static readonly GUIContent SecondLabel = new GUIContent("Second Label",
            "The second label is blended with the first. It may be empty.");
        private static readonly GUIContent Blend = new GUIContent("Blend",
            "The blend is 0 for the first label alone and 1 for the second label alone.");
        private static readonly GUIContent Stiffness = new GUIContent("Stiffness (N/m)",
            "The stiffness of the spring model is the force per metre of penetration depth. 0 takes the model's " +
            "value for the label.");
        private static readonly GUIContent Effects = new GUIContent("Effects",
            "The effects are what the tip feels here. An effect that no surface uses takes no time.");
        private static readonly (string Name, GUIContent Content)[] EffectToggles =
        {
            ("texture", new GUIContent("Texture", "The tip feels the material's texture while it slides.")),
            ("impact", new GUIContent("Impact", "The tip feels an impact at touch-down, stronger the faster it " +
                "arrives.")),
            ("edge", new GUIContent("Edge",
                "The tip feels edges, and the transition to a rougher or smoother label.")),
        };
        private static readonly GUIContent Strength = new GUIContent("Strength",
            "Strength is the gain of the output while this material is touched, from 0 to 1.");

        private static readonly GUIContent FeatureScale = new GUIContent("Feature Scale",
            "The features of the material, its ribs included, are larger by this factor, 0.25 to 4. The level does " +
            "not change.");
        private static readonly GUIContent Tone = new GUIContent("Tone (dB/octave)",
            "The tone tilts the spectrum about 150 Hz, by -12 to 12 dB per octave. Above 0 is brighter, below 0 " +
            "darker.");

        public override float GetPropertyHeight(SerializedProperty property, GUIContent label) =>
            InspectorRows.Height * (FieldRows + (label.text.Length > 0 ? 1 : 0)) -
            EditorGUIUtility.standardVerticalSpacing;

        public override void OnGUI(Rect position, SerializedProperty property, GUIContent label)
        {
            var row = new Rect(position.x, position.y, position.width, EditorGUIUtility.singleLineHeight);
            if (label.text.Length > 0)
            {
                EditorGUI.LabelField(row, label.text, EditorStyles.boldLabel);
                row.y += InspectorRows.Height;
            }
            SerializedProperty first = property.FindPropertyRelative("label");
            SerializedProperty second = property.FindPropertyRelative("secondLabel");
            bool isLearnt = DrawLearnt(row, property);
            row.y += InspectorRows.Height;
            LabelField.Draw(row, first, isLearnt ? LabelBehind : Label, false);
            row.y += InspectorRows.Height;
            LabelField.Draw(row, second, SecondLabel, true);
            row.y += InspectorRows.Height;
            bool blends = second.hasMultipleDifferentValues || second.stringValue.Length > 0;
            using (new EditorGUI.DisabledScope(!blends))
            {
                EditorGUI.PropertyField(row, property.FindPropertyRelative("blend"), Blend);
            }
            row.y += InspectorRows.Height;
            DrawStiffness(row, property.FindPropertyRelative("stiffnessNewtonsPerMetre"), first);
            row.y += InspectorRows.Height;
            EditorGUI.PropertyField(row, property.FindPropertyRelative("strength"), Strength);
            row.y += InspectorRows.Height;
            EditorGUI.PropertyField(row, property.FindPropertyRelative("featureScale"), FeatureScale);
            row.y += InspectorRows.Height;
            EditorGUI.PropertyField(row, property.FindPropertyRelative("toneDbPerOctave"), Tone);
            row.y += InspectorRows.Height;
            DrawEffects(row, property);
        }

        /// <returns>Whether a learnt material replaces the label.</returns>
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
