#nullable enable
using System.Collections.Generic;
using HaptoFlow.Outputs;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Streams amplitude, frequency and transients to a Touch controller through Meta's SDK. Experimental at
    /// Meta: its store takes no application that uses it, and the headset must be set to allow it. So it plays only where
    /// an author has said so.</summary>
    [DisallowMultipleComponent]
    [DefaultExecutionOrder(1100)]
    [AddComponentMenu("HaptoFlow/Controller Parametric Output")]
    [HelpURL(HelpPages.Home + "effects-and-outputs.html#controller-parametric")]
    public sealed class ControllerParametricOutput : DeviceOutput
    {
        [SerializeField, Tooltip("Parametric haptics are experimental at Meta: the store takes no application that uses " +
            "them, and experimental features must be enabled on the headset. Nothing plays until this is on.")]
        private bool useExperimentalFeature;

        /// <summary>Off, nothing plays. To be set before the output wakes.</summary>
        public bool UseExperimentalFeature
        {
            get => useExperimentalFeature;
            set => useExperimentalFeature = value;
        }

        private protected override void OpenSinks(HapticHand wanted, List<HapticSinks.OpenSink> into)
        {
            if (useExperimentalFeature)
            {
                HapticSinks.Open(HapticForm.Parametric, wanted, into);
                return;
            }
            Debug.LogWarning($"HaptoFlow: {name} is silent: parametric haptics are experimental at Meta, and the store " +
                "takes no application that uses them. Switch on Use Experimental Feature if that is meant.", this);
        }
    }
}
