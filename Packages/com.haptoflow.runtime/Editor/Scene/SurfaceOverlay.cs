#nullable enable
using System.Collections.Generic;
using UnityEditor;
using UnityEditor.Overlays;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>In the scene view: which colliders can be felt as what, and which not. A click shows one.</summary>
    [Overlay(typeof(SceneView), "haptoflow-surfaces", "HaptoFlow Surfaces", true)]
    internal sealed class SurfaceOverlay : IMGUIOverlay
    {
        private const int MostLines = 12;
        private const float Width = 300f;

        private static readonly GUIContent Line = new GUIContent("", "Click to show it in the Hierarchy.");
        private SurfaceList? list;
        private bool isStale = true;
        private string title = "";
        private string feltTitle = "";
        private string notFeltTitle = "";

        public override void OnCreated()
        {
            Selection.selectionChanged += Forget;
            EditorApplication.hierarchyChanged += Forget;
            EditorApplication.projectChanged += Forget;
            ObjectChangeEvents.changesPublished += OnChanges;
        }

        public override void OnWillBeDestroyed()
        {
            Selection.selectionChanged -= Forget;
            EditorApplication.hierarchyChanged -= Forget;
            EditorApplication.projectChanged -= Forget;
            ObjectChangeEvents.changesPublished -= OnChanges;
        }

        public override void OnGUI()
        {
            // Between laying out and drawing no line may come.
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

        private void OnChanges(ref ObjectChangeEventStream stream) => Forget();

        private void Forget() => isStale = true;

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
            for (int index = 0; index < lines.Count && index < MostLines; ++index)
            {
                Line.text = lines[index].Text;
                if (GUILayout.Button(Line, EditorStyles.label) && lines[index].Collider != null)
                {
                    EditorGUIUtility.PingObject(lines[index].Collider.gameObject);
                }
            }
            if (lines.Count > MostLines)
            {
                GUILayout.Label("\u2026", EditorStyles.miniLabel);
            }
        }
    }
}
