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
        /// </summary>
        public static void Restart() => HapticSession.ShutDown();

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
