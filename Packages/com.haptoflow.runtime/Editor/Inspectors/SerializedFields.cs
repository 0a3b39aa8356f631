#nullable enable
using System;
using UnityEditor;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>Sets a serialised field of assets or components by its path, as one step of undo.</summary>
    internal static class SerializedFields
    {
        public static void Set(Object target, string path, Action<SerializedProperty> set) =>
            Set(new[] { target }, path, set);

        public static void Set(Object[] targets, string path, Action<SerializedProperty> set)
        {
            using var serialized = new SerializedObject(targets);
            set(serialized.FindProperty(path));
            serialized.ApplyModifiedProperties();
        }
    }
}
