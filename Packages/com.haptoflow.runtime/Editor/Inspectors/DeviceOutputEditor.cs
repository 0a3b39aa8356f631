#nullable enable
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The Inspector of the outputs for devices in a hand. In play mode it shows which device is driven, in
    /// which form, and how late and how evenly it is fed.</summary>
    [CustomEditor(typeof(DeviceOutput), true)]
    [CanEditMultipleObjects]
    internal sealed class DeviceOutputEditor : UnityEditor.Editor
    {
        private static readonly GUIContent Panic = new GUIContent("Panic",
            "Panic silences the output at once. The stylus plays again from its next touch-down on.");

        private readonly DeviceReadout readout = new DeviceReadout();

        public override bool RequiresConstantRepaint() => Application.isPlaying;

        public override void OnInspectorGUI()
        {
            if (DrawDefaultInspector() && Application.isPlaying)
            {
                foreach (Object each in targets)
                {
                    // The voices learn of a changed field by the property only.
                    var changed = (DeviceOutput)each;
                    changed.Muted = changed.Muted;
                }
            }
            if (!Application.isPlaying || targets.Length != 1)
            {
                return;
            }
            var output = (DeviceOutput)target;
            readout.Update(output);
            EditorGUILayout.Space();
            readout.Draw();
            if (GUILayout.Button(Panic))
            {
                output.Panic();
            }
        }
    }
}
