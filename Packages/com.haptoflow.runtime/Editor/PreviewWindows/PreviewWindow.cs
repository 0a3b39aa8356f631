#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Preview;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>A window with controls left and charts right, whose sounds are made in the background.</summary>
    internal abstract class PreviewWindow<TState> : EditorWindow
        where TState : PreviewState<TState>
    {
        // A smaller window scrolls.
        private const float MinimumWidth = 480f;
        private const float MinimumHeight = 320f;

        [SerializeField]
        private TState? state;

        private PreviewView? view;
        private Vector2 scroll;

        /// <summary>For scripts and tests that control the window.</summary>
        internal TState State => state!;

        /// <summary>Of the last event.</summary>
        protected PreviewView View => view!;

        protected abstract PreviewRoom Room { get; }

        /// <summary>False after <see cref="Release"/>.</summary>
        protected abstract bool IsOpen { get; }

        protected static void Open<TWindow>(float width, float height)
            where TWindow : EditorWindow
        {
            bool isNew = !HasOpenInstances<TWindow>();
            var window = GetWindow<TWindow>();
            if (isNew)
            {
                Rect place = window.position;
                window.position = new Rect(place.x, place.y, width, height);
            }
        }

        protected virtual void OnEnable()
        {
            minSize = new Vector2(MinimumWidth, MinimumHeight);
            if (state == null)
            {
                state = CreateInstance<TState>();
                state.hideFlags = HideFlags.HideAndDontSave;
            }
            Begin();
            Undo.undoRedoPerformed += OnUndo;
            EditorApplication.update += Step;
            AssemblyReloadEvents.beforeAssemblyReload += Release;
        }

        protected virtual void OnDisable()
        {
            Undo.undoRedoPerformed -= OnUndo;
            EditorApplication.update -= Step;
            AssemblyReloadEvents.beforeAssemblyReload -= Release;
            Release();
        }

        protected void OnDestroy()
        {
            if (state != null)
            {
                DestroyImmediate(state);
            }
        }

        protected void OnGUI()
        {
            if (!IsOpen)
            {
                return;
            }
            if (TakesKey(Event.current))
            {
                // The change may need controls that this event did not lay out.
                Repaint();
                return;
            }
            view = PreviewView.Of(position, Room, view);
            PreviewLayout layout = view.Layout;
            var all = new Rect(0f, 0f, (float)layout.Width, (float)layout.Height);
            using var scrolled = new GUI.ScrollViewScope(new Rect(0f, 0f, position.width, position.height), scroll, all);
            scroll = scrolled.scrollPosition;
            using (new GUILayout.AreaScope(layout.Controls.ToRect()))
            {
                DrawControls();
            }
            DrawPictures(layout);
        }

        /// <summary>Called at each editor update: submits changes, takes results, and continues playback.</summary>
        internal abstract void Step();

        /// <summary>Called when the window opens, and after each domain reload.</summary>
        protected abstract void Begin();

        /// <summary>Frees everything that would outlive a domain reload.</summary>
        protected abstract void Release();

        protected abstract void DrawControls();

        protected abstract void DrawPictures(PreviewLayout layout);

        /// <returns>True where a shortcut used the event.</returns>
        protected virtual bool TakesKey(Event input) => false;

        protected HapticModelAsset? ModelInUse() => State.Model != null ? State.Model : LabelCatalog.ModelInUse();

        /// <summary>Runs after the present event, in whose layout a modal dialog would interfere.</summary>
        protected static void Later(Action dialog) => EditorApplication.delayCall += () => dialog();

        private void OnUndo()
        {
            State.MarkChanged();
            Repaint();
        }
    }

    /// <summary>The settings of a preview window, with undo.</summary>
    internal abstract class PreviewState<TState> : ScriptableObject
        where TState : PreviewState<TState>
    {
        /// <summary>Null for the project's model.</summary>
        public HapticModelAsset? Model;
        public bool Loops;

        /// <summary>Changes whenever a setting may have changed.</summary>
        public int Version { get; private set; }

        /// <summary>Begins the names of undo steps.</summary>
        protected abstract string WindowName { get; }

        /// <summary>Makes a change that can be undone.</summary>
        /// <param name="what">Completes the name of the undo step, for example "Speed".</param>
        public void Change(string what, Action<TState> change)
        {
            Undo.RecordObject(this, $"{WindowName} {what}");
            change((TState)this);
            ++Version;
        }

        /// <summary>Makes the change if a control returned another value than it was given.</summary>
        /// <param name="what">As for <see cref="Change"/>.</param>
        public void Enter<T>(string what, T before, T entered, Action<TState, T> change)
        {
            if (!EqualityComparer<T>.Default.Equals(entered, before))
            {
                Change(what, changed => change(changed, entered));
            }
        }

        public void DrawModel(GUIContent title) => Enter("Model", Model,
            (HapticModelAsset?)EditorGUILayout.ObjectField(title, Model, typeof(HapticModelAsset), false),
            (changed, chosen) => changed.Model = chosen);

        /// <summary>Call this after an undo or redo, or when an asset has changed.</summary>
        public void MarkChanged() => ++Version;
    }
}
