#nullable enable
using System;
using System.Globalization;
using System.Linq;
using System.Text;

namespace HaptoFlow.Studies
{
    /// <summary>The rows of an existing log, checked against the plan. The CSV format has no quoted cells, so lines
    /// split at commas.</summary>
    /// <param name="Content">The complete lines; a last line without line break is dropped.</param>
    /// <param name="ElapsedSeconds">Elapsed seconds of the last row; 0 without one.</param>
    internal sealed record LogTable(byte[] Content, int Rows, double ElapsedSeconds)
    {
        public static string Header(StudyKind kind) => string.Join(",", kind.Columns) + "\n";

        /// <exception cref="FormatException">The file is not a log of this plan; the message names line and
        /// column.</exception>
        public static LogTable Read(StudyPlan plan, byte[] file)
        {
            byte[] content = file.AsSpan(0, Array.LastIndexOf(file, (byte)'\n') + 1).ToArray();
            string[] lines = Decoded(content).Split('\n');
            if (lines[0] + "\n" != Header(plan.Kind))
            {
                throw new FormatException("line 1: expected the columns " + string.Join(",", plan.Kind.Columns) +
                    "; was the file saved by another program?");
            }
            // Splitting at line breaks adds an empty string at the end.
            int rows = lines.Length - 2;
            if (rows > plan.Trials.Count)
            {
                throw new FormatException(
                    $"line {plan.Trials.Count + 2}: the plan has {plan.Trials.Count} trials only");
            }
            for (int row = 0; row < rows; ++row)
            {
                Check(plan, row, lines[row + 1]);
            }
            return new LogTable(content, rows, rows > 0 ? Elapsed(plan.Kind, lines[rows]) : 0.0);
        }

        private static string Decoded(byte[] content)
        {
            try
            {
                return new UTF8Encoding(false, true).GetString(content);
            }
            catch (DecoderFallbackException)
            {
                throw new FormatException("the file is not UTF-8; was it saved by another program?");
            }
        }

        private static void Check(StudyPlan plan, int row, string line)
        {
            string[] fields = line.Split(',');
            if (fields.Length != plan.Kind.Columns.Count)
            {
                throw new FormatException(
                    $"line {row + 2}: {fields.Length} columns; expected {plan.Kind.Columns.Count}");
            }
            foreach (string column in plan.Kind.PlannedColumns)
            {
                string expected = TrialRecord.TextOf(StudyKind.Planned(plan.Trials[row], column));
                string found = fields[Place(plan.Kind, column)];
                if (!string.Equals(found, expected, StringComparison.Ordinal))
                {
                    throw new FormatException(
                        $"line {row + 2}: {column} is \"{found}\"; expected \"{expected}\" by the plan");
                }
            }
            Elapsed(plan.Kind, line);
        }

        private static double Elapsed(StudyKind kind, string line)
        {
            string text = line.Split(',')[Place(kind, "elapsed_seconds")];
            return double.TryParse(text, NumberStyles.Float, CultureInfo.InvariantCulture, out double seconds)
                ? seconds
                : throw new FormatException($"elapsed_seconds is \"{text}\"; expected a number");
        }

        private static int Place(StudyKind kind, string column) => kind.Columns.ToList().IndexOf(column);
    }
}
