using System;
using System.Collections.Generic;
using System.Linq;
using UnityShim;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    /// <summary>A working copy of the serialised fields of one or several objects.</summary>
    public partial class SerializedObject : IDisposable
    {
        private readonly Object[] objects;
        private readonly HashSet<string> changed = new HashSet<string>();
        private Dictionary<string, object?>[] values;

        public SerializedObject(Object obj)
            : this(new[] { obj })
        {
        }

        public SerializedObject(Object[] objs)
        {
            if (objs.Length == 0 || objs.Any(each => each == null))
            {
                throw new ArgumentException("Object at index 0 is null");
            }
            objects = objs;
            values = Read();
        }

        public Object targetObject => objects[0];

        public Object[] targetObjects => objects;

        public void Dispose()
        {
        }

        public void Update()
        {
            values = Read();
            changed.Clear();
        }

        public SerializedProperty FindProperty(string propertyPath) =>
            SerializedFields.Find(targetObject.GetType(), propertyPath) is { } found
                ? new SerializedProperty(this, propertyPath, found.Field, found.Type)
                : null!;

        public bool ApplyModifiedProperties()
        {
            if (changed.Count > 0)
            {
                Undo.RecordObjects(objects, "Inspector");
            }
            return ApplyModifiedPropertiesWithoutUndo();
        }

        public bool ApplyModifiedPropertiesWithoutUndo()
        {
            bool any = changed.Count > 0;
            foreach (string path in changed)
            {
                for (int index = 0; index < objects.Length; ++index)
                {
                    SerializedFields.Set(objects[index], path, values[index][path]);
                }
            }
            changed.Clear();
            if (any)
            {
                Array.ForEach(objects, Messages.Validate);
                ObjectChangeEvents.Publish();
            }
            return any;
        }

        internal object? Value(string path) => values[0].TryGetValue(path, out object? value) ? value : null;

        internal bool Differs(string path) => values[0].Keys
            .Where(leaf => leaf == path || leaf.StartsWith(path + ".", StringComparison.Ordinal))
            .Any(leaf => values.Any(
                each => !each.TryGetValue(leaf, out object? other) || !Equals(other, values[0][leaf])));

        internal void SetValue(string path, object? value)
        {
            foreach (Dictionary<string, object?> each in values)
            {
                each[path] = value;
            }
            changed.Add(path);
        }

        private Dictionary<string, object?>[] Read() => objects.Select(SerializedFields.Snapshot).ToArray();
    }
}
