#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The Inspector of a stylus. In play mode, it shows what the stylus touches and the state of its voice.
    /// </summary>
    [CustomEditor(typeof(HapticStylus))]
    [CanEditMultipleObjects]
    internal sealed class HapticStylusEditor : UnityEditor.Editor
    {
        private const string TouchBy = "touchBy";
        private const string ForceFields = "forceDecision.";

        private static readonly (string Field, GUIContent Title)[] Fields =
        {
            ("tip", new GUIContent("Tip", "The tip is the centre of the sphere that touches. When it is empty, this " +
                "object is the tip.")),
            ("tipRadiusMetres", new GUIContent("Tip Radius (m)",
                "The tip sphere has this radius, in metres, and contact begins this far from a surface. A pen has " +
                "0.002.")),
            ("layers", new GUIContent("Layers", "The stylus feels colliders on these layers.")),
            ("update", new GUIContent("Update",
                "The stylus reads its pose in rendered frames, which follow the hand best, or in fixed updates, " +
                "which suit tips that physics moves.")),
            ("force", new GUIContent("Tip Force",
                "The component measures the tip force, in newtons. When it is empty, the spring model f = k d gives " +
                "the force.")),
            (TouchBy, new GUIContent("Touch By",
                "With Geometry, a touch is the tip cutting into a surface. With Measured Force, the tip force near a " +
                "surface decides, for a real object under the virtual one.")),
            ("forceDecision.pressNewtons", new GUIContent("Press Force (N)", "A touch begins at this force, in " +
                "newtons.")),
            ("forceDecision.releaseNewtons", new GUIContent("Release Force (N)",
                "A touch ends at this force, in newtons. It has to be below the press force by more than the " +
                "sensor's noise.")),
            ("forceDecision.nearMetres", new GUIContent("Near (m)",
                "A pressing tip touches a surface within this distance on either side, in metres. The distance has " +
                "to exceed the errors of tracking and alignment.")),
            ("output", new GUIContent("Output",
                "The wave plays on this output. When it is empty, it plays on the scene's output, or on one that " +
                "play mode adds.")),
            ("hand", new GUIContent("Hand",
                "This hand holds the stylus. In a scene without outputs, the wave plays on the device in this hand. " +
                "An XR Pen sets the field.")),
            ("strength", new GUIContent("Strength", "Strength is a gain from 0 to 1, multiplied with those of " +
                "surface and output.")),
            ("events.touchBegan", new GUIContent("Touch Began", "Touch Began is raised when the tip touches a " +
                "surface.")),
            ("events.touchMoved", new GUIContent("Touch Moved", "Touch Moved is raised in every update while the " +
                "touch lasts.")),
            ("events.surfaceChanged", new GUIContent("Surface Changed",
                "Surface Changed is raised when the tip slides onto another surface without lifting off.")),
            ("events.touchEnded", new GUIContent("Touch Ended", "Touch Ended is raised when the touch ends, with the " +
                "surface touched last.")),
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
            ReadoutView.Draw("Now", readout.Rows);
        }

        private SerializedProperty Property(string field) =>
            properties[System.Array.FindIndex(Fields, each => each.Field == field)];
    }
}
