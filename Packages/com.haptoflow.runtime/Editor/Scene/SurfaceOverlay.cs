#nullable enable
using System.Collections.Generic;
using System.Linq;
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

    internal sealed record SurfaceLine(Collider Collider, string Text);

    /// <summary>Lists what colliders feel like and by which rule, and which colliders are not felt: those of the
    /// selection, or those of the open scenes when the selection has none.</summary>
    internal sealed class SurfaceList
    {
        private SurfaceList(IReadOnlyList<Collider> colliders, bool ofSelection)
        {
            OfSelection = ofSelection;
            var maps = new SceneMaps();
            ColliderMaterial[] answers = colliders.Select(maps.Ask).ToArray();
            NotFelt = answers.Where(answer => !answer.CanBeFelt).Select(LineOf).ToArray();
            Felt = answers.Where(answer => answer.CanBeFelt).Select(LineOf).ToArray();
        }

        public bool OfSelection { get; }
        public IReadOnlyList<SurfaceLine> Felt { get; }
        public IReadOnlyList<SurfaceLine> NotFelt { get; }

        public static SurfaceList Of(IReadOnlyList<GameObject> selected)
        {
            IReadOnlyList<Collider> ofSelection = SceneColliders.Below(selected);
            return ofSelection.Count > 0
                ? new SurfaceList(ofSelection, true)
                : new SurfaceList(SceneColliders.InScenes(), false);
        }

        /// <summary>The line of a collider, with the reason when a rule decides.</summary>
        private static SurfaceLine LineOf(ColliderMaterial answer)
        {
            string felt = answer.CanBeFelt ? $"{answer.Collider.name}: {answer.Material}" : answer.Collider.name;
            bool isByRule = answer.Surface is null && answer.ByRules.Parts.Any(part => part.Map is object);
            return new SurfaceLine(answer.Collider, isByRule ? $"{felt} ({answer.Reason})" : felt);
        }
    }
}
