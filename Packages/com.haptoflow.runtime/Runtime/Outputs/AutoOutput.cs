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
        // Serialised, so that they survive a recompilation while playing.
        [SerializeField, HideInInspector]
        private bool isMade;
        [SerializeField, HideInInspector]
        private bool hadDevice;
        private HapticOutput? left;

        internal override bool IsMade => isMade;

        /// <summary>Creates an output for the device in the stylus's hand at the first call; true where it plays the
        /// stylus.</summary>
        /// <param name="left">The scene's audio output, which leaves the stylus to the device; or null.</param>
        internal static bool Serves(HapticStylus asker, HapticOutput? left)
        {
            if (asker.Hand == HapticHand.None)
            {
                return false;
            }
            StylusVoices voices = asker.Voices;
            if (voices.Chosen == null)
            {
                voices.Chosen = MadeFor(asker) ?? Make(asker, left);
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

        /// <summary>The output that was made before a recompilation; null without one.</summary>
        private static AutoOutput? MadeFor(HapticStylus asker)
        {
            var found = new List<AutoOutput>();
            asker.GetComponentsInChildren(true, found);
            return found.Find(output => output.isMade && output.transform.parent == asker.transform);
        }

        private static AutoOutput Make(HapticStylus asker, HapticOutput? left)
        {
            var owner = new GameObject("HaptoFlow Auto Output");
            owner.SetActive(false);
            owner.transform.SetParent(asker.transform, false);
            var made = owner.AddComponent<AutoOutput>();
            made.isMade = true;
            made.left = left;
            owner.SetActive(true);
            made.FindDevice();
            return made;
        }

        private protected override void OpenSinks(HapticHand wanted, HeldDevice into) =>
            HapticSinks.OpenBest(wanted, into);

        private protected override void OnDevice(HapticForm form, IHapticSink sink, HapticHand held)
        {
            hadDevice = true;
            bool isLeft = left != null;
            string reason = !isMade ? ""
                : isLeft ? $"{left!.name} plays on every channel, as for loudspeakers, and "
                : "the scene assigns no output, and ";
            string remedy = isLeft
                ? $" Choose a channel on {left!.name}, or name it in the stylus's field Output, to play there instead."
                : "";
            string chosen = form == HapticForm.Waveform
                ? "plays the waveform, which the device supports"
                : "drives the motor with the envelope, since the device does not support waveforms";
            string message = $"HaptoFlow: {(Played != null ? Played.PenName : name)} is felt through {sink.Name} ({held} " +
                $"hand): {reason}Auto Output {chosen}.{remedy}";
            // A route that fails and returns comes here again and again.
            if (said.Add(message))
            {
                Debug.Log(message, this);
            }
        }
    }
}
