#nullable enable

namespace HaptoFlow.Recordings
{
    /// <summary>Says what is wrong with a recording's file, in the words of the other readers.</summary>
    internal static class RecordingError
    {
        public static HaptoFlowException Of(string file, string found, string expected) => new HaptoFlowException(
            HaptoFlowStatus.RecordingUnusable, $"{file}: {found}; expected {expected}");
    }
}
