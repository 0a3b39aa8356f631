#nullable enable
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>A voice of an engine that is no longer in use: it stays on its output until it has faded out. Main
    /// thread, no garbage while nothing changes.</summary>
    internal sealed class FadingVoice
    {
        // A limit for outputs that no longer render. The longest block is 48 ms.
        private const double MaximumSeconds = 0.1;

        private HapticVoice? voice;
        private IVoiceTarget? output;
        private double untilSeconds;

        /// <summary>Takes over the voice and fades it out. A voice that is still fading ends now.</summary>
        public void Take(HapticVoice leavingVoice, IVoiceTarget playedBy)
        {
            Close();
            voice = leavingVoice;
            output = playedBy;
            untilSeconds = Time.unscaledTimeAsDouble + MaximumSeconds;
            if (HasFallenSilent(true))
            {
                Close();
            }
        }

        /// <summary>Call once an update.</summary>
        public void Update()
        {
            if (voice != null && (HasFallenSilent(false) || Time.unscaledTimeAsDouble >= untilSeconds))
            {
                Close();
            }
        }

        public void Close()
        {
            if (voice == null)
            {
                return;
            }
            output!.Remove(voice);
            voice.Dispose();
            voice = null;
            output = null;
        }

        private bool HasFallenSilent(bool silence)
        {
            try
            {
                if (silence)
                {
                    voice!.Panic();
                }
                return voice!.Statistics().Silence != HapticSilence.None;
            }
            catch (HaptoFlowException closed) when (closed.Status == HaptoFlowStatus.InvalidArgument)
            {
                // The engine was closed, and the voice with it.
                return true;
            }
        }
    }
}
