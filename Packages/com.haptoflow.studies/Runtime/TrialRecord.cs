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

    /// <summary>A kind of study: its name in logs and the columns of its log.</summary>
    public sealed class StudyKind
    {
        /// <summary>The study of the delays between pen and vibration that people notice.</summary>
        public static readonly StudyKind Latency = new StudyKind("latency",
            new[] { "condition", "delay_ms" },
            new[]
            {
                "system_delay_ms", "artificial_delay_ms", "delivered_delay_ms", "starts", "stops", "answer",
            });

        /// <summary>The study of how similar a virtual material feels to the real one.</summary>
        public static readonly StudyKind Similarity = new StudyKind("similarity",
            new[] { "material", "method" },
            new[]
            {
                "delay_ms", "system_delay_ms", "artificial_delay_ms", "delivered_delay_ms", "real_edges_seconds",
                "virtual_edges_seconds", "free_seconds", "rating",
            });

        private StudyKind(string name, string[] planned, string[] own)
        {
            Name = name;
            PlannedColumns = new[] { "trial", "block" }.Concat(planned).ToArray();
            Columns = PlannedColumns.Concat(own).Concat(new[]
            {
                "response_seconds", "elapsed_seconds", "contact_seconds", "path_mm", "mean_speed_mmps",
                "mean_force_newtons", "underruns", "attempt",
            }).ToArray();
        }

        /// <summary>Name in logs: "latency" or "similarity".</summary>
        public string Name { get; }

        /// <summary>Columns of the log, in order.</summary>
        public IReadOnlyList<string> Columns { get; }

        /// <summary>The first columns of the log, whose values the plan determines.</summary>
        public IReadOnlyList<string> PlannedColumns { get; }

        internal static object Planned(PlannedTrial trial, string column) => column switch
        {
            "trial" => trial.Trial,
            "block" => trial.Block,
            "condition" => trial.Condition!,
            "delay_ms" => trial.DelayMilliseconds!.Value,
            "material" => trial.Material!,
            "method" => trial.Method!,
            _ => throw new ArgumentException($"a plan has no column {column}", nameof(column)),
        };
    }

    /// <summary>A study cannot start, continue or be logged. The message is one line for the operator: what is wrong,
    /// in which file or setting, and what to do.</summary>
    public sealed class StudyException : Exception
    {
        /// <summary>Creates an exception with a message that says what is wrong and what to do.</summary>
        public StudyException(string message, Exception? cause = null)
            : base(message, cause)
        {
        }
    }
}
