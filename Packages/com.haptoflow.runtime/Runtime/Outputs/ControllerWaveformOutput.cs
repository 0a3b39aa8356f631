#nullable enable
using HaptoFlow.Outputs;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Plays the waveform on a controller that supports it: Touch Plus and Touch Pro through Meta's SDK, and
    /// any XR controller that reports haptic buffers.</summary>
    [DisallowMultipleComponent]
    [DefaultExecutionOrder(1100)]
    [AddComponentMenu("HaptoFlow/Controller Waveform Output")]
    [HelpPage(HelpPages.Outputs + "controller-waveform")]
    public sealed class ControllerWaveformOutput : DeviceOutput
    {
        [SerializeField, Tooltip("Queues each submission behind the last one instead of replacing it. Switch it on " +
            "for a controller that buzzes at the frame rate; a frame that comes late then ends the vibration without " +
            "a fade.")]
        private bool queueSubmissions;

        /// <summary>True to queue each submission behind the last one instead of replacing it. Set it before the output
        /// is enabled.</summary>
        public bool QueueSubmissions { get => queueSubmissions; set => queueSubmissions = value; }

        private protected override bool MayReplace => !queueSubmissions;

        private protected override void OpenSinks(HapticHand wanted, HeldDevice into) =>
            HapticSinks.Open(HapticForm.Waveform, wanted, into);
    }
}
