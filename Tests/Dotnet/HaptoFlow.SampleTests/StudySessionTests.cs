#nullable enable
using System;
using System.Globalization;
using System.IO;
using System.Linq;
using HaptoFlow.Model;
using HaptoFlow.Studies;
using NUnit.Framework;

namespace HaptoFlow.SampleTests
{
    /// <summary>A session runs every trial once, in order, despite interruptions.</summary>
    public sealed class StudySessionTests
    {
        private const double Frame = 0.01;

        private StudyFolder folder = null!;
        private StudySession session = null!;
        private double now;

        [SetUp]
        public void BeginASession()
        {
            folder = new StudyFolder();
            now = 1000.0;
            session = new StudySession(folder.Open());
        }

        [TearDown]
        public void RemoveIt() => folder.Dispose();

        private void PassFor(double seconds)
        {
            for (int frame = 0; frame < seconds / Frame - 0.5; ++frame)
            {
                now += Frame;
                session.Advance(now);
            }
        }

        /// <summary>A task of two seconds and an answer after half a second.</summary>
        private void AnswerOne()
        {
            session.Continue();
            PassFor(2.0);
            session.Ask();
            PassFor(0.5);
            session.Answer(StudyFolder.Yes());
        }

        private static string Field(string row, string column) => StudyFolder.Field(row, column);

        private static double SecondsOf(string row) =>
            double.Parse(Field(row, "elapsed_seconds"), CultureInfo.InvariantCulture);

        [Test]
        public void EveryTrialIsRunOnceAndTheSidecarMarksTheSessionFinished()
        {
            while (session.Phase != StudyPhase.Finished)
            {
                Assert.That(session.Trial, Is.Not.Null);
                AnswerOne();
            }
            Assert.That(folder.Rows.Select(row => Field(row, "trial")),
                Is.EqualTo(new[] { "1", "2", "3", "4", "5", "6", "7", "8" }));
            Assert.That(folder.Rows.Select(row => Field(row, "attempt")), Has.All.EqualTo("1"));
            Assert.That(JsonValue.Parse(File.ReadAllText(folder.Sidecar))["finished"].AsBoolean(), Is.True);
            Assert.That(session.Trial, Is.Null);
        }

        [Test]
        public void TimesAreMeasuredFromTheQuestionAndFromTheStartWithoutPauses()
        {
            PassFor(100.0);
            AnswerOne();
            AnswerOne();
            Assert.That(Field(folder.Rows[0], "response_seconds"), Is.EqualTo("0.5"));
            Assert.That(SecondsOf(folder.Rows[1]), Is.EqualTo(5.0).Within(0.011));
        }

        [Test]
        public void RepeatedAnswersAndAnswersWithoutAQuestionAreNotRecorded()
        {
            Assert.That(session.Answer(StudyFolder.Yes()), Is.False);
            session.Ask();
            Assert.That(session.Phase, Is.EqualTo(StudyPhase.Paused));
            session.Continue();
            Assert.That(session.Answer(StudyFolder.Yes()), Is.False);
            session.Ask();
            session.Ask();
            session.Continue();
            Assert.That(session.Answer(StudyFolder.Yes()), Is.True);
            Assert.That(session.Answer(StudyFolder.Yes()), Is.False);
            Assert.That(folder.Rows, Has.Length.EqualTo(1));
        }

        [Test]
        public void APauseDuringATrialRestartsItAsAFurtherAttempt()
        {
            session.Continue();
            PassFor(1.0);
            session.PauseHere();
            PassFor(60.0);
            session.Continue();
            PassFor(1.0);
            session.Ask();
            session.PauseHere();
            Assert.That(session.Answer(StudyFolder.Yes()), Is.False, "the question is closed");
            AnswerOne();
            Assert.That((Field(folder.Rows[0], "trial"), Field(folder.Rows[0], "attempt")), Is.EqualTo(("1", "3")));
            Assert.That(SecondsOf(folder.Rows[0]), Is.EqualTo(4.5).Within(0.011));
            Assert.That(session.Attempt, Is.EqualTo(1), "the next trial is at its first attempt");
        }

        [TestCase(-500.0)]
        [TestCase(3.0)]
        [TestCase(1e9)]
        public void AClockJumpDuringATrialPausesTheSessionAndIsNotCounted(double seconds)
        {
            AnswerOne();
            PassFor(1.0);
            double before = session.ElapsedSeconds;
            now += seconds;
            session.Advance(now);
            Assert.That((session.Phase, session.Pause), Is.EqualTo((StudyPhase.Paused, StudyPause.ClockJump)));
            Assert.That(session.ElapsedSeconds, Is.EqualTo(before));
            AnswerOne();
            Assert.That(Field(folder.Rows[1], "attempt"), Is.EqualTo("2"));
        }

        [Test]
        public void ACrashDuringATrialNeitherLosesNorRepeatsAnswers()
        {
            AnswerOne();
            AnswerOne();
            session.Continue();
            PassFor(1.0);
            now = 5.0;
            session = new StudySession(folder.Open());
            Assert.That((session.Phase, session.Trial!.Trial, session.Attempt), Is.EqualTo((StudyPhase.Paused, 3, 2)));
            while (session.Phase != StudyPhase.Finished)
            {
                AnswerOne();
            }
            Assert.That(folder.Rows.Select(row => Field(row, "trial")), Is.Unique);
            Assert.That(folder.Rows, Has.Length.EqualTo(8));
            Assert.That(folder.Rows.Select(row => Field(row, "attempt")),
                Is.EqualTo(new[] { "1", "1", "2", "1", "1", "1", "1", "1" }));
            double[] elapsed = folder.Rows.Select(SecondsOf).ToArray();
            Assert.That(elapsed, Is.Ordered);
            Assert.That(elapsed[2], Is.EqualTo(7.5).Within(0.03), "the time continues from the last row");
        }

        [Test]
        public void AfterACrashBehindTheLastAnswerOnlyTheEndIsWritten()
        {
            for (int trial = 0; trial < 7; ++trial)
            {
                AnswerOne();
            }
            session.Continue();
            session.Ask();
            session.Answer(StudyFolder.Yes());
            string sidecar = File.ReadAllText(folder.Sidecar);
            File.WriteAllText(folder.Sidecar, sidecar.Replace("\"finished\":true", "\"finished\":false"));
            session = new StudySession(folder.Open());
            session.Advance(now);
            Assert.That(session.Phase, Is.EqualTo(StudyPhase.Finished));
            Assert.That(JsonValue.Parse(File.ReadAllText(folder.Sidecar))["finished"].AsBoolean(), Is.True);
        }

        [Test]
        public void AFullDiskPausesTheSessionUntilTheRowIsWritten()
        {
            session.Continue();
            session.Ask();
            folder.Files.Failure = new IOException("No space left on device");
            session.Answer(StudyFolder.Yes());
            Assert.That(session.Phase, Is.EqualTo(StudyPhase.Disk));
            int attempts = folder.Files.Attempts;
            PassFor(5.0);
            Assert.That(session.Phase, Is.EqualTo(StudyPhase.Disk));
            Assert.That(session.Problem, Does.Contain("No space left on device"));
            Assert.That(session.Trial!.Trial, Is.EqualTo(1), "the next trial has not started");
            Assert.That(folder.Files.Attempts - attempts, Is.InRange(4, 6), "about once a second");
            folder.Files.Failure = null;
            PassFor(1.5);
            Assert.That((session.Phase, session.Pause), Is.EqualTo((StudyPhase.Paused, StudyPause.Disk)));
            Assert.That(session.Trial!.Trial, Is.EqualTo(2));
            Assert.That(folder.Rows, Has.Length.EqualTo(1));
        }

        [Test]
        public void AClockThatRunsBackwardsDoesNotDelayTheNextWriteAttempt()
        {
            session.Continue();
            session.Ask();
            folder.Files.Failure = new IOException("No space left on device");
            session.Answer(StudyFolder.Yes());
            PassFor(0.5);
            folder.Files.Failure = null;
            now = -1e6;
            session.Advance(now);
            Assert.That(folder.Rows, Has.Length.EqualTo(1));
        }
    }

    /// <summary>A temporary folder with the logs of a small latency study.</summary>
    internal sealed class StudyFolder : IDisposable
    {
        public string Path { get; } = System.IO.Path.Combine(
            System.IO.Path.GetTempPath(), "haptoflow-study-" + System.IO.Path.GetRandomFileName());

        public FailingFiles Files { get; } = new FailingFiles();

        public string Csv => Directory.GetFiles(Path, "*.csv").Single();

        public string Sidecar => Directory.GetFiles(Path, "*.json").Single();

        public string[] Rows => File.ReadAllText(Csv).TrimEnd('\n').Split('\n').Skip(1).ToArray();

        public static StudyDescription Description(
            int participant = 7, ulong seed = 1, double amplitude = 20.0, double deviceMilliseconds = 5.0,
            string deviceDelaySource = "estimated")
        {
            StudyPlan plan = StudyPlan.Latency(participant, seed, new[] { 50.0, 70.0 });
            var settings = new StudyFields { { "tone", new StudyFields { { "amplitude_mps2", amplitude } } } };
            return new StudyDescription(plan, settings, new SystemDelay(11.1, 0.0, 10.7, deviceMilliseconds))
            {
                Device = new StudyFields
                {
                    { "device_delay_ms", deviceMilliseconds }, { "device_delay_source", deviceDelaySource },
                    { "device_delay_note", "made up" },
                },
            };
        }

        public StudyLog Open(StudyDescription? description = null) =>
            StudyLog.Open(Path, description ?? Description(), Files);

        public static string Field(string row, string column) =>
            row.Split(',')[StudyKind.Latency.Columns.ToList().IndexOf(column)];

        public static TrialRecord Yes() => new TrialRecord().Set("answer", "yes");

        /// <summary>Creates a session that was interrupted after some answers.</summary>
        public void Leave(int answered)
        {
            StudyLog log = Open();
            for (int trial = 0; trial < answered; ++trial)
            {
                log.Append(Yes().Set("elapsed_seconds", 10.0 * (trial + 1)).Set("attempt", 1));
            }
        }

        public void Dispose()
        {
            if (Directory.Exists(Path))
            {
                Directory.Delete(Path, true);
            }
        }
    }

    /// <summary>A file system whose writes can be made to fail.</summary>
    internal sealed class FailingFiles : LogWriter
    {
        /// <summary>The error of every write; null for a disk that works.</summary>
        public Exception? Failure { get; set; }

        /// <summary>Number of bytes of a line that are written before a failure.</summary>
        public int RoomBytes { get; set; }

        public int Attempts { get; private set; }

        public override void Replace(string path, string text)
        {
            Fail();
            base.Replace(path, text);
        }

        public override void AddLine(string path, byte[] before, byte[] line)
        {
            if (Failure != null)
            {
                base.AddLine(path, before, line.AsSpan(0, Math.Min(RoomBytes, line.Length)).ToArray());
            }
            Fail();
            base.AddLine(path, before, line);
        }

        private void Fail()
        {
            ++Attempts;
            if (Failure != null)
            {
                throw Failure;
            }
        }
    }
}
