#nullable enable
using System.Linq;

namespace HaptoFlow.Recordings
{
    /// <summary>The exception for a wrong recording file; its text has the same form as the native library's.</summary>
    internal static class RecordingError
    {
        public static HaptoFlowException Of(string file, string found, string expected) => new HaptoFlowException(
            HaptoFlowStatus.RecordingUnusable, Printable($"{file}: {found}; expected {expected}"));

        /// <summary>Control characters, which the file may hold and a console obeys, as "\u001B".</summary>
        private static string Printable(string text) => string.Concat(text.Select(
            letter => char.IsControl(letter) ? $"\\u{(int)letter:X4}" : letter.ToString()));
    }
}
