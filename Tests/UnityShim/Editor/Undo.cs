using System;
using System.Collections.Generic;
using System.Linq;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    /// <summary>Records groups of changes that can be undone. Redo is left out, because no test needs it.</summary>
    public partial class Undo
    {
        private static readonly List<Step> Steps = new List<Step>();
        private static readonly Dictionary<int, string> Names = new Dictionary<int, string>();
        private static int group;

        public delegate void UndoRedoCallback();

        public static UndoRedoCallback? undoRedoPerformed;

        public static int GetCurrentGroup() => group;

        public static void IncrementCurrentGroup() => ++group;

        public static string GetCurrentGroupName() => Names.TryGetValue(group, out string? name) ? name : "";

        public static void SetCurrentGroupName(string name) => Names[group] = name;

        public static void RecordObject(Object objectToUndo, string name) =>
            RecordObjects(new[] { objectToUndo }, name);

        public static void RecordObjects(Object[] objectsToUndo, string name)
        {
            foreach (Object target in objectsToUndo)
            {
                if (target is Transform place)
                {
                    (Vector3 position, Quaternion rotation, Vector3 scale) =
                        (place.localPosition, place.localRotation, place.localScale);
                    Push(name, () => (place.localPosition, place.localRotation, place.localScale) =
                        (position, rotation, scale));
                    continue;
                }
                Dictionary<string, object?> before = SerializedFields.Snapshot(target);
                Push(name, () => SerializedFields.Restore(target, before));
            }
        }

        public static T AddComponent<T>(GameObject gameObject)
            where T : Component
        {
            T added = gameObject.AddComponent<T>();
            Push("Add Component", () => Object.DestroyImmediate(added));
            return added;
        }

        public static void RegisterCreatedObjectUndo(Object objectToUndo, string name) =>
            Push(name, () => Object.DestroyImmediate(objectToUndo));

        public static void CollapseUndoOperations(int groupIndex)
        {
            for (int index = 0; index < Steps.Count; ++index)
            {
                if (Steps[index].Group > groupIndex)
                {
                    Steps[index] = new Step(groupIndex, Steps[index].Revert);
                }
            }
            group = Math.Max(group, groupIndex);
        }

        /// <summary>Undoes the last group.</summary>
        public static void PerformUndo()
        {
            if (Steps.Count > 0)
            {
                int last = Steps.Max(step => step.Group);
                foreach (Step step in Steps.Where(each => each.Group == last).Reverse())
                {
                    step.Revert();
                }
                Steps.RemoveAll(step => step.Group == last);
                undoRedoPerformed?.Invoke();
            }
            ++group;
        }

        internal static void Reset()
        {
            Steps.Clear();
            Names.Clear();
        }

        private static void Push(string name, Action revert)
        {
            Names.TryAdd(group, name);
            Steps.Add(new Step(group, revert));
        }

        private readonly struct Step
        {
            public readonly int Group;
            public readonly Action Revert;

            public Step(int group, Action revert)
            {
                Group = group;
                Revert = revert;
            }
        }
    }
}
