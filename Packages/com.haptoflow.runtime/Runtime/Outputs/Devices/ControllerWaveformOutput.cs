#nullable enable
using System.Collections.Generic;
using HaptoFlow.Outputs;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Plays the wave itself on a controller that takes one: Touch Plus and Touch Pro through Meta's SDK, and
    /// any XR controller that reports haptic buffers.</summary>
    [DisallowMultipleComponent]
    [DefaultExecutionOrder(1100)]
    [AddComponentMenu("HaptoFlow/Controller Waveform Output")]
    [HelpURL(HelpPages.Home + "effects-and-outputs.html#controller-waveform")]
    public sealed class ControllerWaveformOutput : DeviceOutput
    {
        private protected override void OpenSinks(HapticHand wanted, List<HapticSinks.OpenSink> into) =>
            HapticSinks.Open(HapticForm.Waveform, wanted, into);
    }
}
