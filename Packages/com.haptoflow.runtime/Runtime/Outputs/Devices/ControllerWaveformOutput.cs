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
        [SerializeField, Tooltip("Each submission queues behind the last one, instead of replacing what plays. Switch it " +
            "on for a controller that buzzes at the frame rate; a hitch then ends without a fade.")]
        private bool queueSubmissions;

        /// <summary>Each submission queues behind the last one, instead of replacing what plays. To be set before the
        /// output wakes.</summary>
        public bool QueueSubmissions
        {
            get => queueSubmissions;
            set => queueSubmissions = value;
        }

        private protected override bool MayReplace => !queueSubmissions;

        private protected override void OpenSinks(HapticHand wanted, List<HapticSinks.OpenSink> into) =>
            HapticSinks.Open(HapticForm.Waveform, wanted, into);
    }
}
