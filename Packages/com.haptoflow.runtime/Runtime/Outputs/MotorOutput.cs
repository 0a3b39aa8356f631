#nullable enable
using HaptoFlow.Outputs;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Drives the motor of an MX Ink or of any XR controller with the envelope of the waveform: one amplitude
    /// at a time.</summary>
    [DisallowMultipleComponent]
    [DefaultExecutionOrder(1100)]
    [AddComponentMenu("HaptoFlow/Motor Output")]
    [HelpPage(HelpPages.Outputs + "motor")]
    public sealed class MotorOutput : DeviceOutput
    {
        private protected override void OpenSinks(HapticHand wanted, HeldDevice into) =>
            HapticSinks.Open(HapticForm.Amplitude, wanted, into);
    }
}
