#nullable enable
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>The voice of an engine that is not in use any more: it stays on its output until it has faded. Main
    /// thread, no garbage while nothing changes.</summary>
    internal sealed class LeavingVoice
    {
        // An output that renders nothing would keep it for ever. The longest block is 48 ms.
        private const double MostSeconds = 0.1;

        private HapticVoice? voice;
        private IVoiceTarget? output;
        private double untilSeconds;

        /// <summary>Takes the voice over and has it fade. One that was on its way ends now.</summary>
        public void Take(HapticVoice leavingVoice, IVoiceTarget playedBy)
        {
            Close();
            voice = leavingVoice;
            output = playedBy;
            untilSeconds = Time.unscaledTimeAsDouble + MostSeconds;
            if (HasFallenSilent(true))
            {
                Close();
            }
        }

        /// <summary>Once an update.</summary>
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
                // Its engine was closed, and the voice with it.
                return true;
            }
        }
    }
}
