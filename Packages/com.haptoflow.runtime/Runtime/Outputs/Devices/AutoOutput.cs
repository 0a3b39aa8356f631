#nullable enable
using System.Collections.Generic;
using HaptoFlow.Outputs;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Plays on the best that the device in the hand reports: the wave where it takes one, else the envelope on
    /// its motor. A stylus in a hand gets one by itself where its scene names no output.</summary>
    [DisallowMultipleComponent]
    [DefaultExecutionOrder(1100)]
    [AddComponentMenu("HaptoFlow/Auto Output")]
    [HelpURL(HelpPages.Home + "effects-and-outputs.html#auto")]
    public sealed class AutoOutput : DeviceOutput
    {
        private bool isMade;
        private bool hadDevice;

        /// <inheritdoc/>
        internal override bool IsMade => isMade;

        /// <summary>The stylus is felt through what its hand holds: gives it an output the first time.</summary>
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

        /// <summary>The scene names an output after all.</summary>
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

        // A device that is asleep is waited for: what was felt in a hand is not heard from a speaker instead.
        // One that was never there yet, as in the first frames of a scene, leaves the stylus to an audio output.
        private bool Keeps => hadDevice;

        private static AutoOutput Make(HapticStylus asker)
        {
            var owner = new GameObject("HaptoFlow Auto Output");
            owner.SetActive(false);
            owner.transform.SetParent(asker.transform, false);
            var made = owner.AddComponent<AutoOutput>();
            made.isMade = true;
            owner.SetActive(true);
            made.Look();
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
            string reason = isMade ? "the scene names no output, and " : "";
            string chosen = form == HapticForm.Waveform
                ? "plays the wave, which the device says that it takes"
                : "drives the motor with the wave's envelope, since the device reports nothing better";
            Debug.Log($"HaptoFlow: {(Stylus != null ? Stylus.name : name)} is felt through {sink.Name} ({held} hand): " +
                $"{reason}Auto Output {chosen}.", this);
        }
    }
}
