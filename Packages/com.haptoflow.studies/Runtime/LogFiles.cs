#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text;
using HaptoFlow.Files;
using HaptoFlow.Model;

namespace HaptoFlow.Studies
{
    /// <summary>How a study's log writes. Members throw <see cref="IOException"/> and <see
    /// cref="UnauthorizedAccessException"/>; the tests' own let a write fail.</summary>
    internal class LogWriter
    {
        public virtual void Replace(string path, string text) => WholeFile.Write(path, text);

        /// <summary>Appends a line; it is on disk when the call returns. A failure may leave part of the line, which
        /// the next call removes.</summary>
        /// <param name="before">The expected present contents of the file.</param>
        public virtual void AddLine(string path, byte[] before, byte[] line)
        {
            using var stream = new FileStream(path, FileMode.Open, FileAccess.ReadWrite, FileShare.Read);
            if (!HoldsOnly(stream, before))
            {
                throw new IOException("another program changed the file while the study ran; put it back as it was");
            }
            stream.SetLength(before.Length);
            stream.Seek(0, SeekOrigin.End);
            stream.Write(line, 0, line.Length);
            stream.Flush(true);
        }

        /// <summary>True where the file holds the expected contents, followed at most by one complete or incomplete
        /// line.</summary>
        private static bool HoldsOnly(FileStream stream, byte[] before)
        {
            var copy = new MemoryStream();
            stream.CopyTo(copy);
            byte[] content = copy.ToArray();
            if (!content.AsSpan().StartsWith(before))
            {
                return false;
            }
            int lineEnd = Array.IndexOf(content, (byte)'\n', before.Length);
            return lineEnd < 0 || lineEnd == content.Length - 1;
        }
    }

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

    /// <summary>The progress of a session, as its sidecar records it.</summary>
    /// <param name="Session">8 hexadecimal digits.</param>
    /// <param name="Created">UTC, to the second.</param>
    internal sealed record SidecarState(string Session, string Created)
    {
        public const string Format = "haptoflow-study";
        public const int Version = 1;

        public bool IsFinished { get; set; }

        public List<int> ResumedAtTrials { get; } = new List<int>();

        /// <exception cref="FormatException">The document is not a sidecar; the message names the key.</exception>
        public static SidecarState Read(JsonValue document)
        {
            if (document["format"].AsText() != Format || document["version"].AsInteger() != Version)
            {
                throw new FormatException($"this is not a \"{Format}\" of version {Version}");
            }
            var state = new SidecarState(document["session"].AsText(), document["created"].AsText())
            {
                IsFinished = document["finished"].AsBoolean(),
            };
            state.ResumedAtTrials.AddRange(document["resumed_at_trials"].AsArray().Select(each => each.AsInteger()));
            return state;
        }
    }

    /// <summary>Finds the first difference between two JSON values. JToken.DeepEquals does not say where they
    /// differ.</summary>
    internal static class JsonDifference
    {
        private const string Missing = "missing";

        /// <returns>Path and both values; null where they are equal. A member that only one of the objects has is a
        /// difference.</returns>
        public static (string Path, string Was, string Is)? Find(JsonValue was, JsonValue now)
        {
            Dictionary<string, string> before = Leaves(was).ToDictionary(leaf => leaf.Path, leaf => leaf.Text);
            Dictionary<string, string> after = Leaves(now).ToDictionary(leaf => leaf.Path, leaf => leaf.Text);
            string? path = after.Keys.Concat(before.Keys).FirstOrDefault(each => Value(before, each) != Value(after, each));
            return path == null ? null : (path, Value(before, path), Value(after, path));
        }

        private static string Value(Dictionary<string, string> leaves, string path) =>
            leaves.TryGetValue(path, out string? text) ? text : Missing;

        private static IEnumerable<(string Path, string Text)> Leaves(JsonValue value) =>
            value.IsObject ? value.AsObject().Values.SelectMany(Leaves)
            : value.Elements is { } elements
                ? elements.SelectMany(Leaves).Prepend((value.Path, $"{elements.Count} long"))
            : new[] { (value.Path, JsonText.Of(value)) };
    }
}
