#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The Inspector of a stylus: its tip and its ways out; in play mode what it touches and how its voice
    /// does.</summary>
    [CustomEditor(typeof(HapticStylus))]
    [CanEditMultipleObjects]
    internal sealed class HapticStylusEditor : UnityEditor.Editor
    {
        private static readonly (string Field, GUIContent Title)[] Fields =
        {
            ("tip", new GUIContent("Tip", "Centre of the tip; empty for this object.")),
            ("tipRadiusMetres", new GUIContent("Tip Radius (m)",
                "Of the tip sphere. 0.002 is a pen; contact begins this far from a surface.")),
            ("layers", new GUIContent("Layers", "Layers whose colliders can be felt.")),
            ("update", new GUIContent("Update",
                "Rendered frames follow the hand best. Fixed updates suit tips that physics moves.")),
            ("force", new GUIContent("Tip Force",
                "The stylus's own tip force, in newtons; empty for the spring model f = k d.")),
            ("output", new GUIContent("Output",
                "Where the wave goes; empty for the scene's output, or one that is made.")),
            ("strength", new GUIContent("Strength", "Gain, 0 to 1, on top of the surface's and the output's.")),
        };

        private readonly StylusReadout readout = new StylusReadout();
        private SerializedProperty[] properties = null!;

        private void OnEnable() =>
            properties = System.Array.ConvertAll(Fields, field => serializedObject.FindProperty(field.Field));

        public override bool RequiresConstantRepaint() => Application.isPlaying;

        public override void OnInspectorGUI()
        {
            serializedObject.Update();
            for (int index = 0; index < properties.Length; ++index)
            {
                EditorGUILayout.PropertyField(properties[index], Fields[index].Title);
            }
            serializedObject.ApplyModifiedProperties();
            if (!Application.isPlaying || targets.Length > 1)
            {
                return;
            }
            readout.Update((HapticStylus)target);
            EditorGUILayout.Space();
            ReadoutView.Draw("Now", readout.Rows);
        }
    }
}
