#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using System.Text;

namespace HaptoFlow.Recordings
{
    /// <summary>A CSV table of numbers: columns by name with their unit, converted to SI units. Read without a CSV
    /// library: the format has no quoted cells, and lines are parsed without allocating per cell.</summary>
    internal sealed class RecordingTable
    {
        // Share of rows of the acceleration that may lack numbers.
        private const double ToleratedShare = 0.01;
        private const int MinimumRows = 4;

        private readonly string file;
        private readonly string[] names;
        private readonly List<double>[] numbers;

        private RecordingTable(string file, string[] names)
        {
            this.file = file;
            this.names = names;
            numbers = names.Select(_ => new List<double>()).ToArray();
        }

        public Series? Acceleration { get; private set; }

        /// <summary>Velocity, speed or position, according to its columns.</summary>
        public Series? Motion { get; private set; }

        public Series? Force { get; private set; }

        /// <summary>Columns of unknown name; they are ignored.</summary>
        public IReadOnlyList<string> Unknown { get; private set; } = Array.Empty<string>();

        /// <param name="file">Name of the file, for messages.</param>
        /// <param name="rateHz">Sample rate of a table without column time_s; null for none.</param>
        /// <param name="withAcceleration">False for a motion file.</param>
        /// <exception cref="HaptoFlowException">Names the file, what was found and what is expected.</exception>
        public static RecordingTable Read(string file, byte[] bytes, double? rateHz, bool withAcceleration)
        {
            if (bytes.Length == 0)
            {
                throw RecordingError.Of(file, "empty file", "a table with columns " + ColumnForms.Time +
                    $" and acceleration ({ColumnForms.NamesOf(ColumnForms.Acceleration)})");
            }
            string text = Encoding.UTF8.GetString(bytes).TrimStart('\ufeff');
            int position = 0;
            RecordingTable table = new RecordingTable(file, HeaderOf(file, NextLine(text, ref position)));
            ColumnForm? acceleration = withAcceleration
                ? table.FormIn(ColumnForms.Acceleration, "acceleration")
                : null;
            ColumnForm? motion = table.FormIn(ColumnForms.Motion, "motion");
            ColumnForm? force = table.FormIn(ColumnForms.Force, "force");
            if (withAcceleration && acceleration == null)
            {
                throw RecordingError.Of(file, table.Found(),
                    "acceleration: " + ColumnForms.NamesOf(ColumnForms.Acceleration));
            }
            if (!table.names.Contains(ColumnForms.Time) && !rateHz.HasValue)
            {
                throw RecordingError.Of(file, table.Found() + " without " + ColumnForms.Time,
                    "a column time_s, or the key rate_hz in the file's .json");
            }
            table.ReadRows(text, position);
            table.Acceleration = table.SeriesOf(acceleration, rateHz, true);
            table.Motion = table.SeriesOf(motion, rateHz, false);
            table.Force = table.SeriesOf(force, rateHz, false);
            table.Unknown = table.names.Where(name => !ColumnForms.IsKnown(name)).ToArray();
            return table;
        }

        private static string[] HeaderOf(string file, ReadOnlySpan<char> line)
        {
            string header = line.ToString();
            string[] names = header.Split(',').Select(name => name.Trim().Trim('"')).ToArray();
            if (names.Length == 1 && header.Contains(';'))
            {
                throw RecordingError.Of(file, "columns separated by semicolons",
                    "commas between columns, points in numbers");
            }
            string? twice = names.GroupBy(name => name).FirstOrDefault(same => same.Count() > 1)?.Key;
            return twice == null ? names : throw RecordingError.Of(file, $"column {twice} twice", "each column once");
        }

        private static ReadOnlySpan<char> NextLine(string text, ref int position)
        {
            int begin = position;
            int end = text.IndexOf('\n', begin);
            end = end < 0 ? text.Length : end;
            position = end + 1;
            return text.AsSpan(begin, end - begin).TrimEnd('\r');
        }

        private ColumnForm? FormIn(ColumnForm[] forms, string what) => ColumnForms.FormIn(file, names, forms, what);

        private string Found() => "columns " + string.Join(", ", names);

        private void ReadRows(string text, int position)
        {
            bool[] isKnown = names.Select(ColumnForms.IsKnown).ToArray();
            for (int row = 2; position < text.Length; ++row)
            {
                ReadOnlySpan<char> line = NextLine(text, ref position);
                if (line.IsWhiteSpace())
                {
                    continue;
                }
                for (int column = 0; column < names.Length; ++column)
                {
                    int comma = line.IndexOf(',');
                    ReadOnlySpan<char> cell = (comma < 0 ? line : line.Slice(0, comma)).Trim();
                    line = comma < 0 ? ReadOnlySpan<char>.Empty : line.Slice(comma + 1);
                    if (isKnown[column])
                    {
                        numbers[column].Add(NumberOf(cell, row, column));
                    }
                }
            }
        }

        /// <summary>NaN for an empty cell and for "nan".</summary>
        private double NumberOf(ReadOnlySpan<char> cell, int row, int column)
        {
            if (double.TryParse(cell, NumberStyles.Float, CultureInfo.InvariantCulture, out double number))
            {
                return number;
            }
            bool isMissing = cell.IsEmpty || cell.Equals("nan", StringComparison.OrdinalIgnoreCase);
            return isMissing
                ? double.NaN
                : throw RecordingError.Of(file, $"\"{cell.ToString()}\" in row {row}, column {names[column]}",
                    "numbers only");
        }

        /// <summary>The rows with all numbers of the form, with rising times.</summary>
        private Series? SeriesOf(ColumnForm? form, double? rateHz, bool isStrict)
        {
            if (form == null)
            {
                return null;
            }
            List<double>[] columns = form.Columns.Select(name => numbers[Array.IndexOf(names, name)]).ToArray();
            int time = Array.IndexOf(names, ColumnForms.Time);
            List<double>? clock = time >= 0 ? numbers[time] : null;
            int rows = columns[0].Count;
            var kept = new List<int>(rows);
            int firstBroken = -1;
            for (int row = 0; row < rows; ++row)
            {
                bool isWhole = (clock == null || IsFinite(clock[row])) && columns.All(column => IsFinite(column[row]));
                firstBroken = !isWhole && firstBroken < 0 ? row : firstBroken;
                if (isWhole)
                {
                    kept.Add(row);
                }
            }
            if (isStrict && rows - kept.Count > ToleratedShare * rows)
            {
                throw RecordingError.Of(file,
                    $"no number in row {firstBroken + 2}, column {form.Columns[0]} or {ColumnForms.Time}",
                    "finite numbers");
            }
            if (kept.Count < MinimumRows)
            {
                throw RecordingError.Of(file, $"{kept.Count} rows with numbers in {string.Join(", ", form.Columns)}",
                    "4 rows at least");
            }
            double[] seconds = kept.Select(row => clock != null ? clock[row] : row / rateHz!.Value).ToArray();
            CheckRises(seconds, kept);
            double[][] values = columns
                .Select(column => kept.Select(row => form.Factor * column[row]).ToArray()).ToArray();
            return new Series(seconds, values, form.Columns);
        }

        private void CheckRises(double[] seconds, List<int> rows)
        {
            for (int index = 1; index < seconds.Length; ++index)
            {
                if (!(seconds[index] > seconds[index - 1]))
                {
                    throw RecordingError.Of(file, $"{ColumnForms.Time} does not rise in row {rows[index] + 2}",
                        "times in seconds that rise");
                }
            }
        }

        private static bool IsFinite(double number) => !double.IsNaN(number) && !double.IsInfinity(number);
    }
}
