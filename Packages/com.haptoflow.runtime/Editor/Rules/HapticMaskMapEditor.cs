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
        private static readonly string[] Fields =
        {
            "texture", "largestSize", "secondCoordinates", "tiling", "offset", "red", "green", "blue", "alpha",
        };

        public override void OnInspectorGUI()
        {
            var mask = (HapticMaskMap)target;
            // Read before any field is drawn, so that layout and drawing show the same controls.
            string? problem = MaskBake.ProblemOf(mask);
            Repair[] repairs = MaskBake.RepairsOf(mask).ToArray();
            serializedObject.Update();
            foreach (string field in Fields)
            {
                EditorGUILayout.PropertyField(serializedObject.FindProperty(field));
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
