#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>The window of Window > HaptoFlow > Check Scene. It lists what keeps a scene from being felt, with
    /// buttons for remedies, and checks again when the scene or the project changes.</summary>
    internal sealed class CheckSceneWindow : EditorWindow
    {
        private static readonly GUIContent Again = new GUIContent("Check Again",
            "Check Again checks the open scenes once more.");
        private static readonly GUIContent Show = new GUIContent("Select", "Select selects the objects of this " +
            "finding.");

        private IReadOnlyList<Finding> findings = Array.Empty<Finding>();
        private SceneChanges? changes;
        private bool isStale = true;
        private string summary = "";
        private string places = "";
        private string effects = "";
        private Vector2 scroll;

        [MenuItem("Window/HaptoFlow/Check Scene", false, 2101)]
        internal static void Open() => GetWindow<CheckSceneWindow>().MarkStale();

        private void OnEnable()
        {
            titleContent = new GUIContent("HaptoFlow Check");
            minSize = new Vector2(360f, 200f);
            changes = new SceneChanges(MarkStale);
        }

        private void OnDisable() => changes?.Dispose();

        internal void OnGUI()
        {
            // Unity draws twice, first to lay out. The findings must not change in between, so actions run at the end.
            if (isStale && Event.current.type == EventType.Layout)
            {
                Run();
            }
            Action? chosen = DrawToolbar();
            using (var view = new EditorGUILayout.ScrollViewScope(scroll))
            {
                scroll = view.scrollPosition;
                if (places.Length > 0)
                {
                    GUILayout.Label(places, EditorStyles.wordWrappedMiniLabel);
                }
                if (effects.Length > 0)
                {
                    GUILayout.Label(effects, EditorStyles.wordWrappedMiniLabel);
                }
                foreach (Finding finding in findings)
                {
                    chosen = Draw(finding) ?? chosen;
                }
            }
            if (chosen != null)
            {
                chosen();
                MarkStale();
            }
        }

        private Action? DrawToolbar()
        {
            using (new EditorGUILayout.HorizontalScope(EditorStyles.toolbar))
            {
                GUILayout.Label(summary, EditorStyles.miniLabel);
                GUILayout.FlexibleSpace();
                return GUILayout.Button(Again, EditorStyles.toolbarButton) ? MarkStale : (Action?)null;
            }
        }

        private static Action? Draw(Finding finding)
        {
            Action? chosen = null;
            EditorGUILayout.HelpBox(finding.Text, finding.Severity);
            if (finding.Objects.Count == 0 && finding.Repairs.Length == 0)
            {
                return null;
            }
            using (new EditorGUILayout.HorizontalScope())
            {
                GUILayout.FlexibleSpace();
                if (finding.Objects.Count > 0 && GUILayout.Button(Show, EditorStyles.miniButton))
                {
                    chosen = () => Select(finding.Objects);
                }
                foreach (Repair repair in finding.Repairs)
                {
                    if (GUILayout.Button(repair.Caption, EditorStyles.miniButton))
                    {
                        chosen = repair.Act;
                    }
                }
            }
            return chosen;
        }

        private static void Select(IReadOnlyList<Object> objects)
        {
            Selection.objects = objects
                .Where(each => each != null)
                .Select(each => each is Component component ? component.gameObject : each)
                .ToArray();
            EditorGUIUtility.PingObject(Selection.activeObject);
        }

        private void Run()
        {
            isStale = false;
            var scene = new SceneContents();
            findings = SceneCheck.Run(scene);
            places = StylusPlaces.Summary(scene);
            effects = EffectRules.Summary(scene);
            int errors = findings.Count(finding => finding.Severity == MessageType.Error);
            int warnings = findings.Count(finding => finding.Severity == MessageType.Warning);
            summary = findings.Count == 0
                ? "No findings"
                : $"{errors} errors, {warnings} warnings, {findings.Count - errors - warnings} remarks";
        }

        private void MarkStale()
        {
            isStale = true;
            Repaint();
        }
    }
}
