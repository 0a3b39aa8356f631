#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>Window > HaptoFlow > Check Scene: what keeps a scene from being felt, and a button where the remedy is
    /// safe. It looks again by itself when the scene or the project changes.</summary>
    internal sealed class CheckSceneWindow : EditorWindow
    {
        private static readonly GUIContent Again = new GUIContent("Check Again", "Looks the open scenes over.");
        private static readonly GUIContent Show = new GUIContent("Select", "Selects what this is about.");

        private IReadOnlyList<Finding> findings = Array.Empty<Finding>();
        private bool isStale = true;
        private string summary = "";
        private string effects = "";
        private Vector2 scroll;

        [MenuItem("Window/HaptoFlow/Check Scene", false, 2101)]
        internal static void Open() => GetWindow<CheckSceneWindow>().Forget();

        private void OnEnable()
        {
            titleContent = new GUIContent("HaptoFlow Check");
            minSize = new Vector2(360f, 200f);
            EditorApplication.hierarchyChanged += Forget;
            EditorApplication.projectChanged += Forget;
            ObjectChangeEvents.changesPublished += OnChanges;
        }

        private void OnDisable()
        {
            EditorApplication.hierarchyChanged -= Forget;
            EditorApplication.projectChanged -= Forget;
            ObjectChangeEvents.changesPublished -= OnChanges;
        }

        internal void OnGUI()
        {
            // Between laying out and drawing no finding may come, and acting would change what is drawn: it comes last.
            if (isStale && Event.current.type == EventType.Layout)
            {
                Run();
            }
            Action? chosen = DrawToolbar();
            using (var view = new EditorGUILayout.ScrollViewScope(scroll))
            {
                scroll = view.scrollPosition;
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
                Forget();
            }
        }

        private Action? DrawToolbar()
        {
            using (new EditorGUILayout.HorizontalScope(EditorStyles.toolbar))
            {
                GUILayout.Label(summary, EditorStyles.miniLabel);
                GUILayout.FlexibleSpace();
                return GUILayout.Button(Again, EditorStyles.toolbarButton) ? Forget : (Action?)null;
            }
        }

        private static Action? Draw(Finding finding)
        {
            Action? chosen = null;
            EditorGUILayout.HelpBox(finding.Text, finding.Severity);
            if (finding.Objects.Count == 0 && finding.Repairs.Count == 0)
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
            effects = EffectRules.Summary(scene);
            int errors = findings.Count(finding => finding.Severity == MessageType.Error);
            int warnings = findings.Count(finding => finding.Severity == MessageType.Warning);
            summary = findings.Count == 0
                ? "Nothing to remark"
                : $"{errors} errors, {warnings} warnings, {findings.Count - errors - warnings} remarks";
        }

        private void OnChanges(ref ObjectChangeEventStream stream) => Forget();

        private void Forget()
        {
            isStale = true;
            Repaint();
        }
    }
}
