#nullable enable
using System.Collections.Generic;
using HaptoFlow.Outputs;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Plays in the best form that the device in the hand supports: the waveform, else the envelope on its
    /// motor. A stylus in a hand gets one automatically where its scene assigns no output.</summary>
    [DisallowMultipleComponent]
    [DefaultExecutionOrder(1100)]
    [AddComponentMenu("HaptoFlow/Auto Output")]
    [HelpPage(HelpPages.Outputs + "auto")]
    public sealed class AutoOutput : DeviceOutput
    {
        private readonly HashSet<string> said = new HashSet<string>();
        private bool isMade;
        private bool hadDevice;

        /// <inheritdoc/>
        internal override bool IsMade => isMade;

        /// <summary>Creates an output for the device in the stylus's hand at the first call; true where it plays the
        /// stylus.</summary>
        internal static bool Serves(HapticStylus asker)
        {
            if (asker.Hand == HapticHand.None)
            {
                return false;
            }
            StylusVoices voices = asker.Voices;
            if (voices.Chosen == null)
            {
                voices.Chosen = Make(asker);
            }
            return voices.Chosen.Keeps;
        }

        /// <summary>Removes the output: the scene assigns another after all.</summary>
        internal static void Retire(HapticStylus stylus)
        {
            AutoOutput? chosen = stylus.Voices.Chosen;
            if (chosen is not null)
            {
                stylus.Voices.Chosen = null;
                if (chosen != null)
                {
                    chosen.enabled = false;
                    Destroy(chosen.gameObject);
                }
            }
        }

        // A device that sleeps keeps the stylus: touches felt in a hand must not switch to a loudspeaker.
        // Without any device so far, as in the first frames of a scene, the stylus uses an audio output.
        private bool Keeps => hadDevice;

        private static AutoOutput Make(HapticStylus asker)
        {
            var owner = new GameObject("HaptoFlow Auto Output");
            owner.SetActive(false);
            owner.transform.SetParent(asker.transform, false);
            var made = owner.AddComponent<AutoOutput>();
            made.isMade = true;
            owner.SetActive(true);
            made.FindDevice();
            return made;
        }

        private protected override void OpenSinks(HapticHand wanted, List<HapticSinks.OpenSink> into)
        {
            HapticSinks.Open(HapticForm.Waveform, wanted, into);
            HapticSinks.Open(HapticForm.Amplitude, wanted, into);
        }

        private protected override void OnDevice(HapticForm form, IHapticSink sink, HapticHand held)
        {
            hadDevice = true;
            string reason = isMade ? "the scene assigns no output, and " : "";
            string chosen = form == HapticForm.Waveform
                ? "plays the waveform, which the device supports"
                : "drives the motor with the envelope, since the device does not support waveforms";
            string message = $"HaptoFlow: {(Stylus != null ? Stylus.name : name)} is felt through {sink.Name} ({held} " +
                $"hand): {reason}Auto Output {chosen}.";
            // A route that fails and returns comes here again and again.
            if (said.Add(message))
            {
                Debug.Log(message, this);
            }
        }
    }
}
