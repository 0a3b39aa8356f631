#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;

namespace HaptoFlow.Studies
{
    /// <summary>An answered trial, column by column, as it is written to the log. Columns that are not set stay empty.
    /// Any thread, one at a time.</summary>
    public sealed class TrialRecord
    {
        private readonly Dictionary<string, string> values = new Dictionary<string, string>(StringComparer.Ordinal);

        /// <summary>Value of a column; empty where it was not set.</summary>
        public string this[string column] => values.TryGetValue(column, out string? value) ? value : "";

        /// <summary>Sets a text without comma, quotation mark or line break.</summary>
        /// <exception cref="ArgumentException">The text contains one of these.</exception>
        public TrialRecord Set(string column, string word)
        {
            if (word.IndexOfAny(new[] { ',', '"', '\n', '\r' }) >= 0)
            {
                throw new ArgumentException($"{column}: \"{word}\" must not contain a comma, a quotation mark or a " +
                    "line break", nameof(word));
            }
            values[column] = word;
            return this;
        }

        /// <summary>Sets a number, rounded to six decimals; a number that is not finite leaves the column
        /// empty.</summary>
        public TrialRecord Set(string column, double number)
        {
            values[column] = TextOf(number);
            return this;
        }

        /// <summary>Sets the planned total delay and its parts: the system's, and what an output adds.</summary>
        /// <exception cref="StudyException">The system's delay exceeds the planned one.</exception>
        public TrialRecord SetDelay(double plannedMilliseconds, SystemDelay system)
        {
            double artificial = system.ArtificialMilliseconds(plannedMilliseconds);
            return Set("delay_ms", plannedMilliseconds)
                .Set("system_delay_ms", system.TotalMilliseconds)
                .Set("artificial_delay_ms", artificial)
                .Set("delivered_delay_ms", system.TotalMilliseconds + artificial);
        }

        internal static string TextOf(double number) => double.IsNaN(number) || double.IsInfinity(number)
            ? ""
            : number.ToString("0.######", CultureInfo.InvariantCulture);

        internal static string TextOf(object planned) =>
            planned is double number ? TextOf(number) : Convert.ToString(planned, CultureInfo.InvariantCulture)!;

        /// <summary>The row of the log, without line break.</summary>
        /// <exception cref="ArgumentException">A column was set that the study's log does not have.</exception>
        internal string Row(StudyKind kind)
        {
            string? unknown = values.Keys.FirstOrDefault(column => !kind.Columns.Contains(column));
            if (unknown != null)
            {
                throw new ArgumentException($"the log of the study \"{kind.Name}\" has no column {unknown}");
            }
            return string.Join(",", kind.Columns.Select(column => this[column]));
        }
    }
}
