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
        private const string TouchBy = "touchBy";
        private const string OfForce = "forceDecision.";

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
            (TouchBy, new GUIContent("Touch By",
                "Geometry: the tip cuts into a surface. Measured Force: the tip force decides near a surface, for a " +
                "real object under the virtual one.")),
            ("forceDecision.pressNewtons", new GUIContent("Press Force (N)", "A touch begins at this force.")),
            ("forceDecision.releaseNewtons", new GUIContent("Release Force (N)",
                "A touch ends at this force: below the press force by more than the sensor's noise.")),
            ("forceDecision.nearMetres", new GUIContent("Near (m)",
                "How far from a surface, on either side, the pressing tip may be: more than tracking and alignment " +
                "are off.")),
            ("output", new GUIContent("Output",
                "Where the wave goes; empty for the scene's output, or one that is made.")),
            ("hand", new GUIContent("Hand",
                "The hand that holds this. In a scene that names no output it is felt through what that hand holds; an " +
                "XR Pen sets it.")),
            ("strength", new GUIContent("Strength", "Gain, 0 to 1, on top of the surface's and the output's.")),
            ("events.touchBegan", new GUIContent("Touch Began", "The tip touched a surface.")),
            ("events.touchMoved", new GUIContent("Touch Moved", "The touch goes on: once an update.")),
            ("events.surfaceChanged", new GUIContent("Surface Changed",
                "The tip slid from one surface to this one without lifting.")),
            ("events.touchEnded", new GUIContent("Touch Ended", "The touch ended; the surface is the last one.")),
        };

        private readonly StylusReadout readout = new StylusReadout();
        private SerializedProperty[] properties = null!;

        private void OnEnable() =>
            properties = System.Array.ConvertAll(Fields, field => serializedObject.FindProperty(field.Field));

        public override bool RequiresConstantRepaint() => Application.isPlaying;

        public override void OnInspectorGUI()
        {
            serializedObject.Update();
            // What is shown is decided before anything is changed: nothing is drawn that was not laid out.
            bool byForce = Property(TouchBy).enumValueIndex == (int)TouchDecision.MeasuredForce;
            bool lacksForce = byForce && Property("force").objectReferenceValue == null;
            for (int index = 0; index < properties.Length; ++index)
            {
                if (byForce || !Fields[index].Field.StartsWith(OfForce, System.StringComparison.Ordinal))
                {
                    EditorGUILayout.PropertyField(properties[index], Fields[index].Title);
                }
            }
            if (lacksForce && targets.Length == 1)
            {
                EditorGUILayout.HelpBox("Without a Tip Force geometry decides.", MessageType.Info);
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
