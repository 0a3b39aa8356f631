#nullable enable
using Unity.Profiling;

namespace HaptoFlow
{
    /// <summary>Markers for the profiler. Inference runs on a thread of the native library, which the profiler does not
    /// show: its times are in the engine's statistics.</summary>
    internal static class Markers
    {
        public static readonly ProfilerMarker Contact = new ProfilerMarker("HaptoFlow.Contact");
        public static readonly ProfilerMarker Publish = new ProfilerMarker("HaptoFlow.Publish");
        public static readonly ProfilerMarker Render = new ProfilerMarker("HaptoFlow.Render");
    }
}
