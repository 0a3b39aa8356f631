#nullable enable
using System;
using System.Collections.Generic;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
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
