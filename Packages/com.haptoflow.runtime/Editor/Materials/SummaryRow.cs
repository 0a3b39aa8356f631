#nullable enable
using System.Globalization;

namespace HaptoFlow.Editor
{
    /// <summary>A row of an Inspector: a name and its value, both as text.</summary>
    internal sealed record SummaryRow(string Name, string Value)
    {
        /// <summary>Formats values for a row, the same in every language of the system.</summary>
        public static string Format(string format, params object[] values) =>
            string.Format(CultureInfo.InvariantCulture, format, values);
    }
}
