#nullable enable
using HaptoFlow.Outputs;
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

    /// <summary>The state of an output for a device in play mode: device, form, delay and gaps.</summary>
    internal sealed class DeviceReadout : Readout<DeviceOutput>
    {
        protected override void Read(DeviceOutput output)
        {
            HapticForm? form = output.Form;
            if (form == null)
            {
                Add("Device", output.SearchedHand == HapticHand.None
                    ? "none: the stylus is in no hand, so choose one in Hand"
                    : "none in the {0} hand that takes this output", output.SearchedHand.InWords());
                return;
            }
            HapticQueueStatistics statistics = output.Statistics;
            Add("Device", "{0}, {1} hand", output.DeviceName, output.SearchedHand.InWords());
            Add("Form", NameOf(form.Value));
            Add("Latency", statistics.LatencyMilliseconds > 0.0
                ? "{0:0.0} ms, without device and radio" : "nothing plays", statistics.LatencyMilliseconds);
            if (statistics.RateHz > 0.0)
            {
                Add("Rate", "{0:0} Hz", statistics.RateHz);
            }
            Add("Submissions", "{0}", statistics.Submissions);
            Add("Gaps", "{0}", statistics.Gaps);
            Add("Realigned", "{0} times", statistics.Alignments);
            Add("Stopped", "{0} times", statistics.Stops);
            Add("Device changed", "{0} times", statistics.DeviceChanges);
        }

        private static string NameOf(HapticForm form) => form switch
        {
            HapticForm.Waveform => "the waveform itself",
            HapticForm.Parametric => "amplitude and frequency over time",
            _ => "one amplitude at a time",
        };
    }
}
