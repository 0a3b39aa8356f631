#nullable enable

namespace HaptoFlow.Editor
{
    /// <summary>Why nothing is felt, in words and with the remedy where there is one.</summary>
    internal static class SilenceWords
    {
        public static string Of(in VoiceStatistics voice)
        {
            switch (voice.Silence)
            {
                case HapticSilence.None:
                    return "it sounds";
                case HapticSilence.Rest:
                    return "rest: nothing touches, or the tip does not slide";
                case HapticSilence.Stale:
                    return "stale: no contact state came for 100 ms";
                case HapticSilence.Muted:
                    return "muted";
                case HapticSilence.Paused:
                    return "the application is paused";
                case HapticSilence.Panic:
                    return "panic: the next touch-down sounds";
                case HapticSilence.Rate when !voice.IsRateSupported:
                    return "the device's sample rate is outside 8 to 192 kHz";
                case HapticSilence.Rate:
                    return "the device changed its sample rate";
                case HapticSilence.Closing:
                    return "the voice is being closed";
                case HapticSilence.WorkerDead:
                    return "the thread that generates has ended";
                default:
                    return "a reason that this version does not know: " + (int)voice.Silence;
            }
        }

        /// <summary>Why a stylus has no voice.</summary>
        public static string OfMissingVoice(HapticStylus stylus)
        {
            HapticOutput? output = stylus.Output;
            if (output != null && !output.isActiveAndEnabled)
            {
                return $"none: {output.name} is switched off";
            }
            if (output == null && SceneOutputs.AreSwitchedOff)
            {
                return "none: the scene's output is switched off";
            }
            return stylus.isActiveAndEnabled ? "none yet" : "none: the stylus is switched off";
        }
    }
}
