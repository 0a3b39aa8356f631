#nullable enable

namespace HaptoFlow.Editor
{
    /// <summary>Describes why nothing is felt, with the remedy where there is one.</summary>
    internal static class SilenceWords
    {
        public static string Of(in VoiceStatistics voice)
        {
            switch (voice.Silence)
            {
                case HapticSilence.None:
                    return "none: it plays";
                case HapticSilence.Rest:
                    return "rest: nothing touches, or the tip does not slide";
                case HapticSilence.Stale:
                    return "stale: no contact state came for 100 ms";
                case HapticSilence.Muted:
                    return "muted";
                case HapticSilence.Paused:
                    return "the application is paused";
                case HapticSilence.Panic:
                    return "panic: it plays again from the next touch-down on";
                case HapticSilence.Rate when !voice.IsRateSupported:
                    return $"the device's sample rate is outside {OutputRules.MinimumRateHz} to " +
                        $"{OutputRules.MaximumRateHz} Hz";
                case HapticSilence.Rate:
                    return "the device changed its sample rate";
                case HapticSilence.Closing:
                    return "the voice is being closed";
                case HapticSilence.WorkerDead:
                    return "the worker thread has ended";
                case HapticSilence.TurnedDown:
                    return "turned down: a strength or the ceiling is 0";
                default:
                    return "unknown reason " + (int)voice.Silence;
            }
        }

        /// <summary>Describes why a stylus has no voice.</summary>
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
