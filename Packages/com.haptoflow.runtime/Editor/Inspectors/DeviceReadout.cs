#nullable enable
using HaptoFlow.Outputs;

namespace HaptoFlow.Editor
{
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
