#nullable enable
using System;
using System.Collections.Generic;
using Unity.Profiling;

namespace HaptoFlow
{
    /// <summary>Entry points of HaptoFlow for scripts. Main thread.</summary>
    public static class Haptics
    {
        /// <summary>True when the model is loaded and touches can be played.</summary>
        public static bool IsReady
        {
            get
            {
                HapticSession.Existing?.Poll();
                return HapticSession.Existing?.Engine != null;
            }
        }

        /// <summary>Why there are no haptics; null where there is no error, or before anything was started.</summary>
        public static string? Problem => HapticSession.Existing?.Problem;

        /// <summary>Names of the loaded model's labels; empty before it is loaded.</summary>
        public static IReadOnlyList<string> Labels => HapticSession.Existing?.Labels.All ?? Array.Empty<string>();

        /// <summary>Number of learnt materials that the engine has registered.</summary>
        public static int LearntMaterials => HapticSession.Existing?.Learnt?.Felt ?? 0;

        /// <summary>Number of learnt materials that the engine refused, each with a warning in the console: their
        /// labels are used instead.</summary>
        public static int RefusedMaterials => HapticSession.Existing?.Learnt?.Refused ?? 0;

        /// <summary>Starts loading the model on another thread now, rather than when the first stylus is
        /// enabled.</summary>
        public static void Prepare() => HapticSession.Current.Poll();

        /// <summary>Closes the engine. The next stylus starts it again with the settings of that time. Models of <see
        /// cref="Load"/> stay loaded, but none of them stays in use.</summary>
        public static void Restart() => HapticSession.Restart();

        /// <summary>Loads a model on another thread, in addition to the one in use; <see cref="HapticLoadedModel.Use"/>
        /// then switches to it between two frames. For scenes that change or compare models while they run.</summary>
        /// <param name="quality">Selects the tier.</param>
        /// <returns>The loaded model. The caller disposes it, which closes its engine.</returns>
        public static HapticLoadedModel Load(HapticModelAsset model, HapticQuality quality) =>
            new HapticLoadedModel(model, quality);

        /// <summary>Makes styluses use the model of the settings again, from their next update. Loaded models stay
        /// loaded.</summary>
        public static void UseSettings() => HapticSession.UseSettings();

        /// <summary>Changes the quality from the next segment on, and in the active settings.</summary>
        public static void SetQuality(HapticQuality quality)
        {
            HaptoFlowSettings.Active.Quality = quality;
            HapticSession.Existing?.SetQuality(quality);
        }

        /// <summary>Message of the last failed inference, or of the worker's end; empty where there was none. Makes
        /// garbage where there is one.</summary>
        public static string LastFailure => HapticSession.Existing?.Engine?.LastFailure() ?? "";

        /// <summary>Silences every stylus at once; each sounds again with its next touch-down.</summary>
        public static void Panic() => HapticVoice.PanicAll();

        /// <summary>Leaves the device in a hand to another vibration: outputs of that hand send nothing for so long, then
        /// return where the texture is by then. Call it in the frame in which the application sends an impulse of its
        /// own, before or after it; a device plays one vibration at a time, and the next submission would end the
        /// impulse. Impulses that are sent through the Input System are noticed without this call.</summary>
        /// <param name="hand">The hand; <see cref="HapticHand.None"/> for both.</param>
        /// <param name="seconds">Length of the other vibration, in s, up to 60. Calls that overlap last until the later
        /// end; 0, less and NaN do nothing.</param>
        public static void Yield(HapticHand hand, float seconds) => HandYields.Yield(hand, seconds);

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

    /// <summary>Markers for the profiler. Inference runs on a thread of the native library, which the profiler does not
    /// show: its times are in the engine's statistics.</summary>
    internal static class Markers
    {
        public static readonly ProfilerMarker Contact = new ProfilerMarker("HaptoFlow.Contact");
        public static readonly ProfilerMarker Publish = new ProfilerMarker("HaptoFlow.Publish");
        public static readonly ProfilerMarker Render = new ProfilerMarker("HaptoFlow.Render");
    }
}
