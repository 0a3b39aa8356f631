#nullable enable
using System;
using System.IO;
using System.Linq;
using System.Text;
using HaptoFlow.Model;
using HaptoFlow.Studies;
using NUnit.Framework;

namespace HaptoFlow.SampleTests
{
    /// <summary>The logs of a study survive file errors and are never overwritten.</summary>
    public sealed class StudyLogTests
    {
        private StudyFolder folder = null!;

        [SetUp]
        public void MakeAFolder() => folder = new StudyFolder();

        [TearDown]
        public void RemoveIt() => folder.Dispose();

        [Test]
        public void EveryAnswerIsOnDiskWhenAppendReturnsWithTheColumnsOfTheSchema()
        {
            StudyLog log = folder.Open();
            Assert.That(Path.GetFileName(folder.Csv), Does.Match("^latency-P07-[0-9a-f]{8}\\.csv$"));
            Assert.That(File.ReadAllText(folder.Csv), Is.EqualTo(
                "trial,block,condition,delay_ms,system_delay_ms,artificial_delay_ms,delivered_delay_ms,starts,stops," +
                "answer,response_seconds,elapsed_seconds,contact_seconds,path_mm,mean_speed_mmps,mean_force_newtons," +
                "underruns,attempt\n"));
            TrialRecord record = new TrialRecord()
                .SetDelay(50.0, new SystemDelay(11.25, 0.0, 10.5, 5.0))
                .Set("starts", 3).Set("stops", 2).Set("answer", "no").Set("response_seconds", 1.25)
                .Set("elapsed_seconds", 12.5).Set("contact_seconds", 6.0625).Set("path_mm", 900.123456789)
                .Set("mean_speed_mmps", double.NaN).Set("underruns", 0ul).Set("attempt", 1);
            Assert.That(log.Append(record), Is.True);
            Assert.That(folder.Rows, Is.EqualTo(new[]
            {
                "1,practice,turn-on,50,26.75,23.25,50,3,2,no,1.25,12.5,6.0625,900.123457,,,0,1",
            }));
        }

        [Test]
        public void ANumberThatWasLeftOutIsNamedBeforeAHigherOneIsBegun()
        {
            Assert.That(LeftOutBelow(1), Is.Empty);
            Assert.That(LeftOutBelow(2), Does.StartWith("participant P01 has no log here"));
            folder.Open(StudyFolder.Description(1));
            Assert.That(LeftOutBelow(2), Is.Empty);
            Assert.That(LeftOutBelow(5), Does.StartWith("participant P02 and 2 more has no log here"));
            folder.Open(StudyFolder.Description(4));
            Assert.That(LeftOutBelow(5), Does.StartWith("participant P02 and 1 more has no log here"));
            folder.Open(StudyFolder.Description(2));
            folder.Open(StudyFolder.Description(3));
            Assert.That(LeftOutBelow(5), Is.Empty);
            Assert.That(StudyLog.NumbersLeftOut(folder.Path, StudyKind.Similarity, 2), Is.Not.Empty,
                "each study has participants of its own");
        }

        [Test]
        public void OtherFilesAndFoldersThatCannotBeReadAreNoParticipants()
        {
            Assert.That(StudyLog.NumbersLeftOut("\0", StudyKind.Latency, 5), Is.Empty.Or.Contains("P01"));
            Directory.CreateDirectory(folder.Path);
            File.WriteAllText(Path.Combine(folder.Path, "latency-Px1-12345678.csv"), "");
            File.WriteAllText(Path.Combine(folder.Path, "latency-P01.csv"), "");
            Assert.That(LeftOutBelow(2), Does.StartWith("participant P01 has no log here"));
        }

        private string LeftOutBelow(int participant) =>
            StudyLog.NumbersLeftOut(folder.Path, StudyKind.Latency, participant);

        [Test]
        public void TheSidecarContainsStudyDeviceDelaySettingsAndPlan()
        {
            StudyLog log = folder.Open(StudyFolder.Description(seed: (1ul << 63) + 5));
            JsonValue sidecar = JsonValue.Parse(File.ReadAllText(folder.Sidecar));
            Assert.That(sidecar["format"].AsText(), Is.EqualTo("haptoflow-study"));
            Assert.That(sidecar["version"].AsInteger(), Is.EqualTo(1));
            Assert.That(sidecar["study"].AsText(), Is.EqualTo("latency"));
            Assert.That(sidecar["participant"].AsInteger(), Is.EqualTo(7));
            Assert.That(sidecar["session"].AsText(), Is.EqualTo(log.Session));
            Assert.That(sidecar["seed"].AsUnsigned64(), Is.EqualTo((1ul << 63) + 5), "exact above 2^53");
            Assert.That(sidecar["simulated"].AsBoolean(), Is.False);
            Assert.That(sidecar["created"].AsText(), Does.Match("^\\d{4}-\\d\\d-\\d\\dT\\d\\d:\\d\\d:\\d\\dZ$"));
            Assert.That(sidecar["finished"].AsBoolean(), Is.False);
            Assert.That(sidecar["resumptions"].AsInteger(), Is.Zero);
            Assert.That(sidecar["device"]["device_delay_ms"].AsNumber(), Is.EqualTo(5.0));
            Assert.That(sidecar["device"]["device_delay_source"].AsText(), Is.EqualTo("estimated"));
            Assert.That(sidecar["delay"]["pose_interval_ms"].AsNumber(), Is.EqualTo(11.1));
            Assert.That(sidecar["delay"]["inference_ms"].AsNumber(), Is.Zero);
            Assert.That(sidecar["settings"]["tone"]["amplitude_mps2"].AsNumber(), Is.EqualTo(20.0));
            Assert.That(sidecar["plan"].AsArray(), Has.Count.EqualTo(8));
            Assert.That(sidecar["plan"][0]["trial"].AsInteger(), Is.EqualTo(1));
            Assert.That(sidecar["plan"][0]["block"].AsText(), Is.EqualTo("practice"));
            Assert.That(sidecar["plan"][0]["delay_ms"].AsNumber(), Is.EqualTo(50.0));
        }

        [TestCase("8,")]
        [TestCase("3,practice,turn-off,50,1,2,3,4,5,yes,1,30,1,1,1,1,0,1")]
        [TestCase("\0\0\0\0\0\0")]
        public void AnIncompleteLastRowIsDroppedAndItsTrialRepeated(string torn)
        {
            folder.Leave(answered: 2);
            File.AppendAllText(folder.Csv, torn);
            StudyLog log = folder.Open();
            Assert.That(log.Answered, Is.EqualTo(2));
            Assert.That(log.Resumptions, Is.EqualTo(1));
            Assert.That(log.AttemptsAt(3), Is.EqualTo(2));
            Assert.That(log.AttemptsAt(4), Is.EqualTo(1));
            Assert.That(log.ElapsedSeconds, Is.EqualTo(20.0));
            Assert.That(log.Append(StudyFolder.Yes()), Is.True);
            Assert.That(folder.Rows.Select(row => row.Split(',')[0]), Is.EqualTo(new[] { "1", "2", "3" }));
        }

        [TestCase(0)]
        [TestCase(17)]
        [TestCase(int.MaxValue)]
        public void ARowIsKeptAndReportedUntilAFullDiskAcceptsIt(int roomBytes)
        {
            StudyLog log = folder.Open();
            log.Append(StudyFolder.Yes());
            folder.Files.Failure = new IOException("No space left on device");
            folder.Files.RoomBytes = roomBytes;
            Assert.That(log.Append(StudyFolder.Yes()), Is.False);
            Assert.That(log.TryWritePending(), Is.False);
            Assert.That(log.Problem, Does.Contain(log.CsvPath).And.Contain("No space left on device"));
            Assert.That(log.HasPending, Is.True);
            Assert.That(log.Answered, Is.EqualTo(1));
            Assert.That(() => log.Append(StudyFolder.Yes()), Throws.InvalidOperationException, "rows keep their order");
            folder.Files.Failure = null;
            Assert.That(log.TryWritePending(), Is.True);
            Assert.That(log.Problem, Is.Null);
            Assert.That(folder.Rows.Select(row => row.Split(',')[0]), Is.EqualTo(new[] { "1", "2" }));
        }

        [Test]
        public void ADiskThatIsFullAtTheEndLeavesTheSessionOpenUntilTheSidecarIsWritten()
        {
            folder.Leave(answered: 8);
            StudyLog log = folder.Open();
            folder.Files.Failure = new IOException("No space left on device");
            Assert.That(log.Finish(), Is.False);
            Assert.That(log.IsFinished, Is.False);
            Assert.That(log.Problem, Does.Contain(log.SidecarPath));
            folder.Files.Failure = null;
            Assert.That(log.Finish(), Is.True);
            Assert.That(JsonValue.Parse(File.ReadAllText(folder.Sidecar))["finished"].AsBoolean(), Is.True);
        }

        [Test]
        public void AFolderThatIsNotWritableIsRefusedByName()
        {
            folder.Files.Failure = new UnauthorizedAccessException("Access to the path is denied.");
            Assert.That(() => folder.Open(), Throws.TypeOf<StudyException>().With.Message.StartsWith(folder.Path).And
                .Message.Contains("choose a writable folder"));
        }

        [TestCase("a\0b")]
        [TestCase("")]
        public void AnInvalidFolderPathIsRefused(string path) => Assert.That(
            () => StudyLog.Open(path, StudyFolder.Description(), folder.Files),
            Throws.TypeOf<StudyException>().With.Message.Contains("choose a writable folder"));

        [Test]
        public void AParticipantWhoHasFinishedIsRefusedAndNothingIsTouched()
        {
            folder.Leave(answered: 8);
            folder.Open().Finish();
            byte[] before = File.ReadAllBytes(folder.Csv);
            Assert.That(() => folder.Open(), Throws.TypeOf<StudyException>().With.Message.Contains(folder.Sidecar).And
                .Message.Contains("participant 7 has finished"));
            Assert.That(File.ReadAllBytes(folder.Csv), Is.EqualTo(before));
            Assert.That(() => folder.Open(StudyFolder.Description(participant: 70)), Throws.Nothing, "P70 is not P07");
        }

        [Test]
        public void ASessionWithOtherSettingsIsRefusedWithKeyAndBothValues()
        {
            folder.Leave(answered: 2);
            byte[] before = File.ReadAllBytes(folder.Sidecar);
            AssertRefused(StudyFolder.Description(amplitude: 25.0), "settings.tone.amplitude_mps2 = 20", "25");
            AssertRefused(StudyFolder.Description(seed: 2), "seed = 1", "2");
            AssertRefused(StudyFolder.Description(deviceMilliseconds: 9.0), "device.device_delay_ms = 5", "9");
            StudyDescription simulated = StudyFolder.Description();
            simulated.IsSimulated = true;
            AssertRefused(simulated, "simulated = false", "true");
            AssertRefused(StudyFolder.Description(deviceDelaySource: "measured"), "device_delay_source = \"estimated\"", "\"measured\"");
            StudyDescription model = StudyFolder.Description();
            model.Models = new[] { new StudyModel("ours", "default.haptoflow", new string('a', 64)) };
            AssertRefused(model, "models = 0 long", "1 long");
            Assert.That(File.ReadAllBytes(folder.Sidecar), Is.EqualTo(before));
        }

        private void AssertRefused(StudyDescription other, string was, string now) => Assert.That(
            () => folder.Open(other), Throws.TypeOf<StudyException>().With.Message.StartsWith(folder.Sidecar).And
                .Message.Contains(was).And.Message.Contains("the value is now " + now));

        [TestCase("trial,block\n1,practice\n", "line 1")]
        [TestCase("", "line 1")]
        [TestCase("HEADER\r\n", "line 1")]
        [TestCase("HEADER\n1,practice,turn-on\n", "line 2: 3 columns")]
        [TestCase("HEADER\n1,practice,turn-on,70,,,,,,,,1,,,,,,1\n", "line 2: delay_ms is \"70\"; expected \"50\"")]
        [TestCase("HEADER\n2,practice,turn-on,70,,,,,,,,1,,,,,,1\n", "line 2: trial is \"2\"; expected \"1\"")]
        [TestCase("HEADER\n1,practice,turn-on,50,,,,,,,,soon,,,,,,1\n", "elapsed_seconds is \"soon\"")]
        public void ATableThatAnotherProgramChangedIsRefusedByLineAndColumn(string content, string message)
        {
            folder.Leave(answered: 0);
            string header = File.ReadAllText(folder.Csv).TrimEnd('\n');
            string changed = content.Replace("HEADER", header);
            File.WriteAllText(folder.Csv, changed);
            Assert.That(() => folder.Open(), Throws.TypeOf<StudyException>().With.Message.StartsWith(folder.Csv).And
                .Message.Contains(message));
            Assert.That(File.ReadAllText(folder.Csv), Is.EqualTo(changed));
        }

        [Test]
        public void ATableThatIsNotUtf8IsRefused()
        {
            folder.Leave(answered: 1);
            byte[] before = File.ReadAllBytes(folder.Csv);
            File.WriteAllBytes(folder.Csv, before.Concat(new byte[] { 0xff, (byte)'\n' }).ToArray());
            Assert.That(() => folder.Open(), Throws.TypeOf<StudyException>().With.Message.Contains("UTF-8"));
        }

        [TestCase("")]
        [TestCase("{")]
        [TestCase("{\"format\": \"haptoflow-study\", \"version\": 2}")]
        [TestCase("[1]")]
        public void ADamagedSidecarIsRefusedByName(string text)
        {
            folder.Leave(answered: 1);
            File.WriteAllText(folder.Sidecar, text);
            Assert.That(() => folder.Open(),
                Throws.TypeOf<StudyException>().With.Message.StartsWith(folder.Sidecar));
        }

        [Test]
        public void AMissingFileOfTheTwoIsRefusedWhereAnswersMayBeLost()
        {
            folder.Leave(answered: 1);
            string sidecar = folder.Sidecar;
            string text = File.ReadAllText(sidecar);
            File.Delete(sidecar);
            Assert.That(() => folder.Open(), Throws.TypeOf<StudyException>().With.Message.StartsWith(sidecar));
            File.WriteAllText(sidecar, text);
            string csv = folder.Csv;
            File.Delete(csv);
            Assert.That(() => folder.Open(), Throws.TypeOf<StudyException>().With.Message.StartsWith(csv));
        }

        [Test]
        public void ASessionCanStartAfterACrashBetweenItsTwoFiles()
        {
            folder.Leave(answered: 0);
            string csv = folder.Csv;
            File.Delete(folder.Sidecar);
            StudyLog log = folder.Open();
            Assert.That(log.CsvPath, Is.EqualTo(csv));
            Assert.That(File.Exists(log.SidecarPath), Is.True);
            Assert.That(log.Resumptions, Is.Zero);
        }

        [Test]
        public void TwoSessionsOfOneParticipantAreRefused()
        {
            folder.Leave(answered: 1);
            File.Copy(folder.Csv, Path.Combine(folder.Path, "latency-P07-00000000.csv"));
            Assert.That(() => folder.Open(), Throws.TypeOf<StudyException>().With.Message.Contains("2 sessions"));
        }

        [Test]
        public void ATableChangedByAnotherProgramDuringTheStudyIsNotOverwritten()
        {
            StudyLog log = folder.Open();
            log.Append(StudyFolder.Yes());
            string kept = File.ReadAllText(folder.Csv);
            File.WriteAllText(folder.Csv, kept.Replace("yes", "no"));
            Assert.That(log.Append(StudyFolder.Yes()), Is.False);
            Assert.That(log.Problem, Does.Contain("another program changed the file"));
            File.Delete(folder.Csv);
            Assert.That(log.TryWritePending(), Is.False);
            File.WriteAllText(log.CsvPath, kept);
            Assert.That(log.TryWritePending(), Is.True);
            Assert.That(folder.Rows, Has.Length.EqualTo(2));
        }

        [Test]
        public void NamesWithCommasAndUnknownColumnsAreRefused()
        {
            Assert.That(() => new TrialRecord().Set("answer", "yes,no"), Throws.ArgumentException);
            Assert.That(() => folder.Open().Append(new TrialRecord().Set("rating", 3)), Throws.ArgumentException);
        }

        [Test]
        public void ASimilarityStudyHasItsOwnColumns()
        {
            StudyPlan plan = StudyPlan.Similarity(3, 1, new[] { "wood", "fur" }, new[] { "ours", "dstn" });
            var description = new StudyDescription(plan, new StudyFields(), new SystemDelay(11, 6, 10, 5));
            StudyLog log = StudyLog.Open(folder.Path, description);
            log.Append(new TrialRecord().Set("rating", 7).SetDelay(60.0, description.Delay).Set("free_seconds", 4.5));
            Assert.That(File.ReadAllText(folder.Csv), Does.StartWith(
                "trial,block,material,method,delay_ms,system_delay_ms,artificial_delay_ms,delivered_delay_ms," +
                "real_edges_seconds,virtual_edges_seconds,free_seconds,rating,response_seconds,"));
            Assert.That(folder.Rows[0], Is.EqualTo("1,practice,wood,ours,60,32,28,60,,,4.5,7,,,,,,,,"));
            Assert.That(JsonValue.Parse(File.ReadAllText(folder.Sidecar, Encoding.UTF8))["plan"][0]["method"].AsText(),
                Is.EqualTo("ours"));
        }
    }
}
