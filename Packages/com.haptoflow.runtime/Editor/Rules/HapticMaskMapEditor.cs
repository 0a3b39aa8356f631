#nullable enable
using System;
using System.Linq;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The Inspector of a mask: its texture, its channels, and a button to bake it.</summary>
    [CustomEditor(typeof(HapticMaskMap))]
    internal sealed class HapticMaskMapEditor : UnityEditor.Editor
    {
        private static readonly GUIContent Source = new GUIContent("Texture",
            "The mask is baked from this texture, which has to be readable meanwhile. At run time only the baked " +
            "copy is used.");
        private static readonly GUIContent Size = new GUIContent("Largest Size",
            "The longer side of the baked mask has at most this many texels. A larger texture is halved until it " +
            "fits.");
        private static readonly GUIContent Second = new GUIContent("Second Coordinates",
            "When it is on, the mask lies over the second texture coordinates of the mesh, else over the first.");
        private static readonly GUIContent Tiling = new GUIContent("Tiling",
            "The texture repeats this often over the texture coordinates.");
        private static readonly GUIContent Offset = new GUIContent("Offset",
            "The texture is shifted by this much over the texture coordinates.");
        private static readonly (string Name, GUIContent Content)[] Channels =
        {
            ("red", new GUIContent("Red", "The red channel selects a material or scales a property.")),
            ("green", new GUIContent("Green", "The green channel selects a material or scales a property.")),
            ("blue", new GUIContent("Blue", "The blue channel selects a material or scales a property.")),
            ("alpha", new GUIContent("Alpha", "The alpha channel selects a material or scales a property.")),
        };

        public override void OnInspectorGUI()
        {
            var mask = (HapticMaskMap)target;
            // Read before any field is drawn, so that layout and drawing show the same controls.
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
