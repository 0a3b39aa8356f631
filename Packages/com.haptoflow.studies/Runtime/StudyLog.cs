#nullable enable
using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text;
using HaptoFlow.Model;

namespace HaptoFlow.Studies
{
    /// <summary>The two files of a session: rows of answered trials as CSV, and a JSON sidecar that describes the
    /// session. Each row is written to disk before the next trial begins. A row that cannot be written stays in memory
    /// and is written later, so that no answer is lost. Main thread.</summary>
    public sealed class StudyLog
    {
        private const string AnotherParticipant = "or choose another participant number";

        private readonly LogWriter writer;
        private readonly StudyDescription description;
        private readonly SidecarState state;
        private byte[] written;
        private byte[]? pending;

        private StudyLog(
            LogWriter writer, string path, StudyDescription description, SidecarState state, LogTable table)
        {
            this.writer = writer;
            this.description = description;
            this.state = state;
            CsvPath = path;
            written = table.Content;
            Answered = table.Rows;
            ElapsedSeconds = table.ElapsedSeconds;
        }

        /// <summary>Path of the table.</summary>
        public string CsvPath { get; }

        /// <summary>Path of the sidecar.</summary>
        public string SidecarPath => SidecarOf(CsvPath);

        /// <summary>Identifier of the session, 8 hexadecimal digits.</summary>
        public string Session => state.Session;

        /// <summary>The plan of the session.</summary>
        public StudyPlan Plan => description.Plan;

        /// <summary>Trials whose rows are on disk.</summary>
        public int Answered { get; private set; }

        /// <summary>Elapsed seconds of the last row on disk, since the session began.</summary>
        public double ElapsedSeconds { get; }

        /// <summary>Number of times that the session was resumed, including this one.</summary>
        public int Resumptions => state.ResumedAtTrials.Count;

        /// <summary>True where the sidecar marks the session as finished.</summary>
        public bool IsFinished => state.IsFinished;

        /// <summary>True while a row is not on disk yet.</summary>
        public bool HasPending => pending != null;

        /// <summary>Why the last attempt to write failed, for the operator; null without an error.</summary>
        public string? Problem { get; private set; }

        /// <summary>What the operator should know about the numbers below the chosen one, because each number has an
        /// order of trials of its own, and only all of them together are counterbalanced; empty where each of them
        /// has a log, or where the folder cannot be read. Any thread. Reads the folder and allocates.</summary>
        /// <param name="kind">The kind of study.</param>
        /// <param name="participant">The number that would be begun next.</param>
        public static string NumbersLeftOut(string folder, StudyKind kind, int participant)
        {
            try
            {
                var present = new HashSet<int>();
                foreach (string path in FilesOf(folder, kind.Name + "-P", ".csv"))
                {
                    string[] words = Path.GetFileNameWithoutExtension(path).Split('-');
                    if (words.Length == 3 && int.TryParse(words[1].Substring(1),
                        System.Globalization.NumberStyles.None, System.Globalization.CultureInfo.InvariantCulture,
                        out int number))
                    {
                        present.Add(number);
                    }
                }
                int[] missing = Enumerable.Range(1, Math.Max(0, participant - 1))
                    .Where(each => !present.Contains(each)).ToArray();
                if (missing.Length == 0)
                {
                    return "";
                }
                string more = missing.Length > 1 ? $" and {missing.Length - 1} more" : "";
                return $"participant P{missing[0]:00}{more} has no log here: begin the lowest number first, or the " +
                    "order of trials is not counterbalanced";
            }
            catch (Exception error) when (IsOfDisk(error) || IsOfPath(error))
            {
                return "";
            }
        }

        /// <summary>Starts a participant's session, or resumes an interrupted one.</summary>
        /// <exception cref="StudyException">The participant has finished this study, the interrupted session used other
        /// settings, a file is damaged, or the folder is not writable. Nothing was overwritten.</exception>
        public static StudyLog Open(string folder, StudyDescription description) =>
            Open(folder, description, new LogWriter());

        internal static StudyLog Open(string folder, StudyDescription description, LogWriter writer)
        {
            try
            {
                if (folder.Length == 0)
                {
                    throw new ArgumentException("the folder for the logs is empty");
                }
                string stem = $"{description.Plan.Kind.Name}-P{description.Plan.Participant:00}-";
                IReadOnlyList<string> tables = FilesOf(folder, stem, ".csv");
                IReadOnlyList<string> sidecars = FilesOf(folder, stem, ".json");
                List<string> sessions = tables
                    .Union(sidecars.Select(each => Path.ChangeExtension(each, ".csv")))
                    .ToList();
                if (sessions.Count > 1)
                {
                    throw new StudyException($"{sessions[0]}: participant {description.Plan.Participant} has " +
                        $"{sessions.Count} sessions in this folder; move all but one elsewhere, {AnotherParticipant}");
                }
                return sessions.Count == 1
                    ? Resume(writer, sessions[0], description)
                    : Begin(writer, Path.Combine(folder, stem + NewSession() + ".csv"), description);
            }
            catch (Exception error) when (IsOfDisk(error) || IsOfPath(error))
            {
                throw new StudyException(
                    $"{folder}: {error.Message}; choose a writable folder in the field Folder of the settings", error);
            }
        }

        /// <summary>Number of attempts at a trial so far: 1, and more after interruptions at that trial.</summary>
        public int AttemptsAt(int trial) => 1 + state.ResumedAtTrials.Count(each => each == trial);

        /// <summary>Writes a row. If that fails, the row is kept: see <see cref="TryWritePending"/>.</summary>
        /// <returns>True where the row is on disk.</returns>
        /// <exception cref="InvalidOperationException">The previous row is not on disk yet, or every trial has its
        /// row.</exception>
        public bool Append(TrialRecord record)
        {
            if (HasPending || Answered == Plan.Trials.Count)
            {
                throw new InvalidOperationException(HasPending
                    ? "the row before this one is not yet on disk"
                    : "every trial of the plan has its row");
            }
            foreach (string column in Plan.Kind.PlannedColumns)
            {
                object planned = StudyKind.Planned(Plan.Trials[Answered], column);
                record.Set(column, TrialRecord.TextOf(planned));
            }
            pending = Encoding.UTF8.GetBytes(record.Row(Plan.Kind) + "\n");
            return TryWritePending();
        }

        /// <summary>Tries again to write the pending row.</summary>
        /// <returns>True where no row is pending.</returns>
        public bool TryWritePending()
        {
            if (pending == null)
            {
                return true;
            }
            byte[] line = pending;
            if (!TryWrite(CsvPath, () => writer.AddLine(CsvPath, written, line)))
            {
                return false;
            }
            written = written.Concat(line).ToArray();
            pending = null;
            ++Answered;
            return true;
        }

        /// <summary>Marks the session as finished in the sidecar.</summary>
        /// <returns>True where the sidecar is on disk.</returns>
        public bool Finish()
        {
            state.IsFinished = true;
            bool isWritten = TryWrite(SidecarPath, WriteSidecar);
            state.IsFinished = isWritten;
            return isWritten;
        }

        private bool TryWrite(string path, Action write)
        {
            try
            {
                write();
                Problem = null;
                return true;
            }
            catch (Exception error) when (IsOfDisk(error))
            {
                Problem = $"{path}: {error.Message}";
                return false;
            }
        }

        private static StudyLog Begin(LogWriter writer, string path, StudyDescription description)
        {
            // The table comes first: a table without sidecar has no answers, while a sidecar without table may have
            // lost some.
            string header = LogTable.Header(description.Plan.Kind);
            writer.Replace(path, header);
            return NewLog(writer, path, description, Encoding.UTF8.GetBytes(header));
        }

        private static StudyLog NewLog(LogWriter writer, string path, StudyDescription description, byte[] content)
        {
            string session = Path.GetFileNameWithoutExtension(path).Split('-').Last();
            var state = new SidecarState(session, DateTime.UtcNow.ToString("yyyy-MM-ddTHH:mm:ssZ",
                System.Globalization.CultureInfo.InvariantCulture));
            var log = new StudyLog(writer, path, description, state, LogTable.Read(description.Plan, content));
            log.WriteSidecar();
            return log;
        }

        private static StudyLog Resume(LogWriter writer, string path, StudyDescription description)
        {
            string sidecar = SidecarOf(path);
            if (!File.Exists(path))
            {
                throw new StudyException(
                    $"{path}: is missing but its sidecar exists; restore it, {AnotherParticipant}");
            }
            if (!File.Exists(sidecar))
            {
                byte[] content = File.ReadAllBytes(path);
                bool isBare = content.SequenceEqual(Encoding.UTF8.GetBytes(LogTable.Header(description.Plan.Kind)));
                return isBare
                    ? NewLog(writer, path, description, content)
                    : throw new StudyException(
                        $"{sidecar}: is missing but its table exists; restore it, {AnotherParticipant}");
            }
            SidecarState state = Checked(sidecar, () => Resumable(sidecar, description));
            LogTable table = Checked(path, () => LogTable.Read(description.Plan, File.ReadAllBytes(path)));
            state.ResumedAtTrials.Add(table.Rows + 1);
            var log = new StudyLog(writer, path, description, state, table);
            log.WriteSidecar();
            return log;
        }

        private static SidecarState Resumable(string sidecar, StudyDescription description)
        {
            JsonValue was = JsonValue.Parse(Encoding.UTF8.GetString(File.ReadAllBytes(sidecar)));
            SidecarState state = SidecarState.Read(was);
            if (state.IsFinished)
            {
                throw new StudyException($"{sidecar}: participant {description.Plan.Participant} has finished this " +
                    "study; choose another participant number");
            }
            JsonValue now = JsonValue.Parse(description.Sidecar(state));
            foreach (string key in description.Fixed().Select(member => member.Key))
            {
                RefuseDifference(sidecar, was[key], now[key]);
            }
            RefuseDifference(sidecar, was["device"]["device_delay_ms"], now["device"]["device_delay_ms"]);
            RefuseDifference(sidecar, was["device"]["device_delay_source"], now["device"]["device_delay_source"]);
            return state;
        }

        private static void RefuseDifference(string sidecar, JsonValue was, JsonValue now)
        {
            (string Path, string Was, string Is)? difference = JsonDifference.Find(was, now);
            if (difference.HasValue)
            {
                (string path, string before, string after) = difference.Value;
                throw new StudyException($"{sidecar}: the session was begun with {path} = {before}, but the " +
                    $"value is now {after}; restore it, {AnotherParticipant}");
            }
        }

        private static T Checked<T>(string path, Func<T> read)
        {
            try
            {
                return read();
            }
            catch (FormatException error)
            {
                throw new StudyException($"{path}: {error.Message}; repair it, {AnotherParticipant}", error);
            }
        }

        private void WriteSidecar() => writer.Replace(SidecarPath, description.Sidecar(state));

        /// <summary>None where the folder is missing.</summary>
        private static IReadOnlyList<string> FilesOf(string folder, string stem, string ending) =>
            !Directory.Exists(folder)
                ? Array.Empty<string>()
                : Directory.GetFiles(folder, stem + "*" + ending)
                    .Where(each => each.EndsWith(ending, StringComparison.Ordinal))
                    .OrderBy(each => each, StringComparer.Ordinal).ToArray();

        private static string SidecarOf(string path) => Path.ChangeExtension(path, ".json");

        private static string NewSession() => Guid.NewGuid().ToString("N").Substring(0, 8);

        private static bool IsOfPath(Exception error) =>
            error is ArgumentException || error is NotSupportedException;

        private static bool IsOfDisk(Exception error) => error is IOException || error is UnauthorizedAccessException;
    }
}
