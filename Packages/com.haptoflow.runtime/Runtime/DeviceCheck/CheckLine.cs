#nullable enable

namespace HaptoFlow.DeviceCheck
{
    /// <summary>What became of a line of the device check.</summary>
    internal enum CheckState
    {
        /// <summary>Measured, and as it should be.</summary>
        Passed,

        /// <summary>Measured or answered, and not as it should be.</summary>
        Failed,

        /// <summary>Not measured here: the text says why.</summary>
        Skipped,

        /// <summary>A question that was asked and not answered.</summary>
        Asked,
    }

    /// <summary>One line of the device check.</summary>
    /// <param name="Measured">What was measured, with units; for a skipped line, why nothing was.</param>
    /// <param name="Remedy">What to do; empty for lines that did not fail.</param>
    internal sealed record CheckLine(string Group, string Name, CheckState State, string Measured, string Remedy)
    {
        /// <summary>A line that passed or failed.</summary>
        public static CheckLine Of(string group, string name, bool passed, string measured, string remedy) =>
            new CheckLine(group, name, passed ? CheckState.Passed : CheckState.Failed, measured, passed ? "" : remedy);

        public static CheckLine Skipped(string group, string name, string why) =>
            new CheckLine(group, name, CheckState.Skipped, why, "");

        public static CheckLine Unanswered(string group, string name) =>
            new CheckLine(group, name, CheckState.Asked, "not answered", "");
    }
}
