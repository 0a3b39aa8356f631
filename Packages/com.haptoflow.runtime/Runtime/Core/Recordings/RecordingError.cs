#nullable enable

namespace HaptoFlow.Recordings
{
    /// <summary>The exception for a wrong recording file; its text has the same form as the native library's.</summary>
    internal static class RecordingError
    {
        public static HaptoFlowException Of(string file, string found, string expected) => new HaptoFlowException(
            HaptoFlowStatus.RecordingUnusable, $"{file}: {found}; expected {expected}");
    }
}
