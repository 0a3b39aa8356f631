#nullable enable
using System;
using System.Linq;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The Inspector of a mask: its texture, what its channels say, and baking.</summary>
    [CustomEditor(typeof(HapticMaskMap))]
    internal sealed class HapticMaskMapEditor : UnityEditor.Editor
    {
        private static readonly GUIContent Source = new GUIContent("Texture",
            "What the channels are baked from. It must be readable while it is baked; at run time only the copy " +
            "counts.");
        private static readonly GUIContent Size = new GUIContent("Largest Size",
            "In texels, of the longer side. A larger texture is baked at half its size, or half of that, until it " +
            "fits.");
        private static readonly GUIContent Second = new GUIContent("Second Coordinates",
            "Off: the mesh's first texture coordinates count. On: its second.");
        private static readonly GUIContent Tiling = new GUIContent("Tiling",
            "How often the texture repeats over the texture coordinates.");
        private static readonly GUIContent Offset = new GUIContent("Offset",
            "Shifts the texture over the texture coordinates.");
        private static readonly (string Name, GUIContent Content)[] Channels =
        {
            ("red", new GUIContent("Red", "What the red channel says.")),
            ("green", new GUIContent("Green", "What the green channel says.")),
            ("blue", new GUIContent("Blue", "What the blue channel says.")),
            ("alpha", new GUIContent("Alpha", "What the alpha channel says.")),
        };

        public override void OnInspectorGUI()
        {
            var mask = (HapticMaskMap)target;
            // What is shown is decided before anything is changed: nothing is drawn that was not laid out.
            string? problem = MaskBake.ProblemOf(mask);
            Repair[] repairs = MaskBake.RepairsOf(mask).ToArray();
            serializedObject.Update();
            EditorGUILayout.PropertyField(serializedObject.FindProperty("texture"), Source);
            EditorGUILayout.PropertyField(serializedObject.FindProperty("largestSize"), Size);
            EditorGUILayout.PropertyField(serializedObject.FindProperty("secondCoordinates"), Second);
            EditorGUILayout.PropertyField(serializedObject.FindProperty("tiling"), Tiling);
            EditorGUILayout.PropertyField(serializedObject.FindProperty("offset"), Offset);
            foreach ((string name, GUIContent content) in Channels)
            {
                EditorGUILayout.PropertyField(serializedObject.FindProperty(name), content);
            }
            serializedObject.ApplyModifiedProperties();
            if (problem != null)
            {
                EditorGUILayout.HelpBox(problem, MessageType.Warning);
            }
            else if (mask.IsBaked)
            {
                EditorGUILayout.HelpBox($"Baked: {mask.Width} x {mask.Height} texels.", MessageType.None);
            }
            Action? chosen = null;
            foreach (Repair repair in repairs)
            {
                if (GUILayout.Button(repair.Caption))
                {
                    chosen = repair.Act;
                }
            }
            chosen?.Invoke();
        }
    }
}
