#nullable enable
using System;
using UnityEditor;

namespace HaptoFlow.Editor
{
    /// <summary>A subscription to changes of the open scenes and of the project, undo included.</summary>
    internal sealed class SceneChanges : IDisposable
    {
        private readonly Action changed;

        /// <summary>Subscribes. Dispose the object to unsubscribe.</summary>
        public SceneChanges(Action changed)
        {
            this.changed = changed;
            EditorApplication.hierarchyChanged += changed;
            EditorApplication.projectChanged += changed;
            ObjectChangeEvents.changesPublished += OnChangesPublished;
        }

        public void Dispose()
        {
            EditorApplication.hierarchyChanged -= changed;
            EditorApplication.projectChanged -= changed;
            ObjectChangeEvents.changesPublished -= OnChangesPublished;
        }

        private void OnChangesPublished(ref ObjectChangeEventStream stream) => changed();
    }
}
