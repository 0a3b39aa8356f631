#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The Inspector of a stylus. In play mode it shows what the stylus touches, and its voice.</summary>
    [CustomEditor(typeof(HapticStylus))]
    [CanEditMultipleObjects]
    internal sealed class HapticStylusEditor : UnityEditor.Editor
    {
        private const string TouchBy = "touchBy";
        private const string ForceFields = "forceDecision.";

        /// <summary>The fields in the order of drawing; a title stands where the name does not say enough.</summary>
        private static readonly (string Field, GUIContent? Title)[] Fields =
        {
            ("tip", null), ("tipRadiusMetres", new GUIContent("Tip Radius (m)")), ("layers", null), ("update", null),
            ("force", new GUIContent("Tip Force")), (TouchBy, null),
            ("forceDecision.pressNewtons", new GUIContent("Press Force (N)")),
            ("forceDecision.releaseNewtons", new GUIContent("Release Force (N)")),
            ("forceDecision.nearMetres", new GUIContent("Near (m)")), ("output", null), ("hand", null),
            ("strength", null), ("rig", null), ("events.touchBegan", null), ("events.touchMoved", null),
            ("events.surfaceChanged", null), ("events.touchEnded", null),
        };

        private readonly StylusReadout readout = new StylusReadout();
        private SerializedProperty[] properties = null!;

        private void OnEnable() =>
            properties = System.Array.ConvertAll(Fields, field => serializedObject.FindProperty(field.Field));

        public override bool RequiresConstantRepaint() => Application.isPlaying;

        public override void OnInspectorGUI()
        {
            serializedObject.Update();
            // Read before any field is drawn, so that layout and drawing show the same fields.
            bool byForce = Property(TouchBy).enumValueIndex == (int)TouchDecision.MeasuredForce;
            bool lacksForce = byForce && Property("force").objectReferenceValue == null;
            for (int index = 0; index < properties.Length; ++index)
            {
                if (byForce || !Fields[index].Field.StartsWith(ForceFields, System.StringComparison.Ordinal))
                {
                    EditorGUILayout.PropertyField(properties[index], Fields[index].Title);
                }
            }
            if (lacksForce && targets.Length == 1)
            {
                EditorGUILayout.HelpBox("The field Tip Force is empty, so geometry decides.", MessageType.Info);
            }
            serializedObject.ApplyModifiedProperties();
            if (!Application.isPlaying || targets.Length > 1)
            {
                return;
            }
            readout.Update((HapticStylus)target);
            EditorGUILayout.Space();
            readout.Draw();
        }

        private SerializedProperty Property(string field) =>
            properties[System.Array.FindIndex(Fields, each => each.Field == field)];
    }
}
