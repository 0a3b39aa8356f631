#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Adds the device check to the open scene, also in play mode: Window > HaptoFlow > Device Check.</summary>
    internal static class DeviceCheckMenu
    {
        [MenuItem("Window/HaptoFlow/Device Check", false, 2103)]
        internal static void Add()
        {
            DeviceCheckRun[] present = Object.FindObjectsByType<DeviceCheckRun>(
                FindObjectsInactive.Include, FindObjectsSortMode.None);
            GameObject owner = present.Length > 0 ? present[0].gameObject : new GameObject("Device Check");
            if (present.Length == 0)
            {
                owner.AddComponent<DeviceCheckRun>();
                if (!Application.isPlaying)
                {
                    Undo.RegisterCreatedObjectUndo(owner, "Create Device Check");
                }
            }
            Selection.activeGameObject = owner;
            Debug.Log("HaptoFlow: the object Device Check " + (Application.isPlaying
                ? "runs in this scene now: follow the words in the game view."
                : "runs when you press Play: follow the words in the game view. Delete it afterwards."), owner);
        }
    }
}
