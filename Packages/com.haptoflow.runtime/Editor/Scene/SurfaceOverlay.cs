#nullable enable
using System.Collections.Generic;
using UnityEditor;
using UnityEditor.Overlays;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>An overlay of the Scene view that lists the colliders that are felt, with their materials, and those
    /// that are not.</summary>
    [Overlay(typeof(SceneView), "haptoflow-surfaces", "HaptoFlow Surfaces", true)]
    internal sealed class SurfaceOverlay : IMGUIOverlay
    {
        private const int MaximumLines = 12;
        private const float Width = 300f;

        private static readonly GUIContent Line = new GUIContent("", "A click shows this object in the Hierarchy.");
        private SurfaceList? list;
        private SceneChanges? changes;
        private bool isStale = true;
        private string title = "";
        private string feltTitle = "";
        private string notFeltTitle = "";

        public override void OnCreated()
        {
            Selection.selectionChanged += MarkStale;
            changes = new SceneChanges(MarkStale);
        }

        public override void OnWillBeDestroyed()
        {
            Selection.selectionChanged -= MarkStale;
            changes?.Dispose();
        }

        public override void OnGUI()
        {
            // Only during layout: the number of lines must not change before Unity draws.
            if (list == null || (isStale && Event.current.type == EventType.Layout))
            {
                Read();
            }
            using (new EditorGUILayout.VerticalScope(GUILayout.Width(Width)))
            {
                GUILayout.Label(title, EditorStyles.miniLabel);
                Draw(notFeltTitle, list!.NotFelt);
                Draw(feltTitle, list.Felt);
            }
        }

        private void MarkStale() => isStale = true;

        private void Read()
        {
            isStale = false;
            list = SurfaceList.Of(Selection.gameObjects);
            title = list.OfSelection ? "In the selection" : "In the scene";
            notFeltTitle = $"Not felt ({list.NotFelt.Count})";
            feltTitle = $"Felt ({list.Felt.Count})";
        }

        private static void Draw(string caption, IReadOnlyList<SurfaceLine> lines)
        {
            GUILayout.Label(caption, EditorStyles.boldLabel);
            for (int index = 0; index < lines.Count && index < MaximumLines; ++index)
            {
                Line.text = lines[index].Text;
                if (GUILayout.Button(Line, EditorStyles.label) && lines[index].Collider != null)
                {
                    EditorGUIUtility.PingObject(lines[index].Collider.gameObject);
                }
            }
            if (lines.Count > MaximumLines)
            {
                GUILayout.Label("\u2026", EditorStyles.miniLabel);
            }
        }
    }
}
