#nullable enable
using HaptoFlow.Outputs;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Streams amplitude, frequency and transients to a Touch controller through Meta's SDK. The feature is
    /// experimental: Meta's store does not accept applications that use it, and the headset must be set to allow it. It
    /// therefore plays only after the author has enabled it.</summary>
    [DisallowMultipleComponent]
    [DefaultExecutionOrder(1100)]
    [AddComponentMenu("HaptoFlow/Controller Parametric Output")]
    [HelpPage(HelpPages.Outputs + "controller-parametric")]
    public sealed class ControllerParametricOutput : DeviceOutput
    {
        [SerializeField, Tooltip("Parametric haptics are experimental at Meta: the store does not accept " +
            "applications that use them, and experimental features must be enabled on the headset. Nothing plays " +
            "until this is on.")]
        private bool useExperimentalFeature;

        /// <summary>Nothing plays while this is false. Set it before the output is enabled.</summary>
        public bool UseExperimentalFeature { get => useExperimentalFeature; set => useExperimentalFeature = value; }

        private protected override void OpenSinks(HapticHand wanted, HeldDevice into)
        {
            if (useExperimentalFeature)
            {
                HapticSinks.Open(HapticForm.Parametric, wanted, into);
                return;
            }
            Debug.LogWarning($"HaptoFlow: {name} is silent: parametric haptics are experimental at Meta, and the " +
                "store does not accept applications that use them. Switch on Use Experimental Feature to play " +
                "anyway.", this);
        }
    }
}
