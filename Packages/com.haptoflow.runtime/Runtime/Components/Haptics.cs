#nullable enable
using System;
using System.Collections.Generic;

namespace HaptoFlow
{
    /// <summary>HaptoFlow as a whole, for programs. Main thread.</summary>
    public static class Haptics
    {
        /// <summary>The model is loaded and touches can sound.</summary>
        public static bool IsReady
        {
            get
            {
                HapticSession.Existing?.Poll();
                return HapticSession.Existing?.Engine != null;
            }
        }

        /// <summary>Why there are no haptics; null where nothing is wrong, or nothing was started yet.</summary>
        public static string? Problem => HapticSession.Existing?.Problem;

        /// <summary>Names of the loaded model's labels; empty before it is loaded.</summary>
        public static IReadOnlyList<string> Labels => HapticSession.Existing?.Labels.All ?? Array.Empty<string>();

        /// <summary>Learnt materials that are felt as they were learnt.</summary>
        public static int LearntMaterials => HapticSession.Existing?.Learnt?.Felt ?? 0;

        /// <summary>Learnt materials that the engine refused, each with a line in the console: their labels are felt
        /// instead.</summary>
        public static int RefusedMaterials => HapticSession.Existing?.Learnt?.Refused ?? 0;

        /// <summary>Loads the model now rather than when the first stylus wakes; the loading is done by another thread.
        /// </summary>
        public static void Prepare() => HapticSession.Current.Poll();

        /// <summary>Closes the engine; it starts anew, with the settings as they are then, when a stylus next asks.
        /// Models of <see cref="Load"/> stay loaded, and none of them is in use any more.</summary>
        public static void Restart() => HapticSession.Restart();

        /// <summary>Loads a model beside the one in use, by another thread; <see cref="HapticLoadedModel.Use"/> then
        /// changes over to it from one frame to the next. For scenes that change or compare models while they run.
        /// </summary>
        /// <param name="quality">Which of its tiers generates.</param>
        /// <returns>The loaded model. The caller disposes it, which closes its engine.</returns>
        public static HapticLoadedModel Load(HapticModelAsset model, HapticQuality quality) =>
            new HapticLoadedModel(model, quality);

        /// <summary>Styluses feel by the model of the settings again, with their next update. Loaded models stay
        /// loaded.</summary>
        public static void UseSettings() => HapticSession.UseSettings();

        /// <summary>From the next segment on; also kept in the active settings. A tier that has to be loaded first is
        /// loaded by another thread, while the present one goes on.</summary>
        public static void SetQuality(HapticQuality quality)
        {
            HaptoFlowSettings.Active.Quality = quality;
            HapticSession.Existing?.SetQuality(quality);
        }

        /// <summary>Text of the engine's newest failed round of inference, or of its worker's end; empty where there
        /// was none. Makes garbage where there is one.</summary>
        public static string LastFailure => HapticSession.Existing?.Engine?.LastFailure() ?? "";

        /// <summary>Silence at once, everywhere. Each stylus sounds again with its next touch-down.</summary>
        public static void Panic() => HapticVoice.PanicAll();

        /// <summary>False before the model is loaded.</summary>
        public static bool TryGetStatistics(out EngineStatistics statistics)
        {
            statistics = default;
            HapticEngine? engine = HapticSession.Existing?.Engine;
            if (engine == null)
            {
                return false;
            }
            statistics = engine.Statistics();
            return true;
        }
    }
}
