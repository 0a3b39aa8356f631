#nullable enable

namespace HaptoFlow.Editor
{
    /// <summary>Describes why nothing is felt, with the remedy where there is one.</summary>
    internal static class SilenceWords
    {
        public static string Of(in VoiceStatistics voice) => voice.Silence switch
        {
            HapticSilence.None => "none: it plays",
            HapticSilence.Rest => "rest: nothing touches, or the tip does not slide",
            HapticSilence.Stale => "stale: no contact state came for 100 ms",
            HapticSilence.Muted => "muted",
            HapticSilence.Paused => "paused: with the application, or by AudioListener.pause",
            HapticSilence.Panic => "panic: it plays again from the next touch-down on",
            HapticSilence.Rate when !voice.IsRateSupported =>
                $"the device's sample rate is outside {OutputRules.MinimumRateHz} to {OutputRules.MaximumRateHz} Hz",
            HapticSilence.Rate => "the device changed its sample rate",
            HapticSilence.Closing => "the voice is being closed",
            HapticSilence.WorkerDead => "the worker thread has ended",
            HapticSilence.TurnedDown => "turned down: a strength or the ceiling is 0",
            _ => "unknown reason " + (int)voice.Silence,
        };

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
            if (output == null && UnityAudio.Problem != null)
            {
                return "none: " + UnityAudio.Problem;
            }
            return stylus.isActiveAndEnabled ? "none yet" : "none: the stylus is switched off";
        }
    }
}
