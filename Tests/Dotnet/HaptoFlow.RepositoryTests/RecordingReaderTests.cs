using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text;
using HaptoFlow.Recordings;
using HaptoFlow.Tests.Support;
using Newtonsoft.Json.Linq;
using NUnit.Framework;

namespace HaptoFlow.RepositoryTests
{
    /// <summary>Recordings as C# gets them from the native reader: the golden set, files of an application, and what the
    /// wrapper adds.</summary>
    public sealed class RecordingReaderTests
    {
        private static readonly string Folder = RepositoryFiles.In("Tests", "Golden", "recordings");

        private static IEnumerable<TestCaseData> Answers() =>
            JArray.Parse(File.ReadAllText(Path.Combine(Folder, "expected.json"))).Cast<JObject>()
                .Select(answer => new TestCaseData(answer).SetName("{m}(" + answer["file"] + ")"));

        [TestCaseSource(nameof(Answers))]
        public void ARecordingHasItsOneRightAnswer(JObject answer)
        {
            string path = Path.Combine(Folder, "files", (string)answer["file"]!);
            if (answer["refused"] is { } refused)
            {
                var refusal = Assert.Throws<HaptoFlowException>(() => RecordingReader.Read(path))!;
                Assert.That(refusal.Status, Is.EqualTo(HaptoFlowStatus.RecordingUnusable));
                string expected = (string)refused!;
                Assert.That(refusal.Message,
                    Does.Contain(expected.StartsWith("FILE") ? path + expected.Substring(4) : expected));
                return;
            }
            Recording recording = RecordingReader.Read(path);
            double rate = (double)answer["rate_hz"]!;
            Assert.That(recording.SampleRateHz, Is.EqualTo(rate).Within(((double?)answer["rate_tolerance"] ?? 1e-6) * rate));
            Assert.That(recording.AxisCount, Is.EqualTo((int)answer["axes"]!));
            Assert.That(recording.SampleCount,
                Is.EqualTo((int)answer["samples"]!).Within((int?)answer["sample_tolerance"] ?? 0));
            AssertFigures(recording, answer);
            Assert.That(recording.Label, Is.EqualTo((string)answer["label"]!));
            Assert.That(recording.Licence, Is.EqualTo((string)answer["licence"]!));
            Assert.That(recording.Source, Is.EqualTo((string)answer["source"]!));
            foreach (JToken note in answer["notes"]!)
            {
                Assert.That(string.Join("\n", recording.Remarks), Does.Contain((string)note!));
            }
            Assert.That(recording.Remarks.Count > 0 == answer["notes"]!.HasValues);
        }

        [Test]
        public void FilesOfAnApplicationAreReadByTheirNames()
        {
            Dictionary<string, byte[]> files = Directory.GetFiles(MadeRecordings.DoormatFolder).ToDictionary(
                path => Path.GetFileName(path).Replace(".bytes", ""), File.ReadAllBytes);
            Recording recording = RecordingReader.Read("doormat.wav", files);
            Assert.That(recording.Name, Is.EqualTo("doormat"));
            Assert.That(recording.KnowsMotion, Is.True, "sidecar and motion file were found");
            Assert.That(recording.Licence, Is.Not.Empty);
            files.Remove("doormat.motion.csv");
            var refusal = Assert.Throws<HaptoFlowException>(() => RecordingReader.Read("doormat.wav", files))!;
            Assert.That(refusal.Message, Does.Contain("doormat.motion.csv, which is not there"));
        }

        [Test]
        public void TheFullScaleOfAWavCanBeGiven()
        {
            string path = Path.Combine(Folder, "files", "wave_alone.wav");
            Recording weak = RecordingReader.Read(path, 10.0);
            Recording strong = RecordingReader.Read(path, 30.0);
            Assert.That(strong.AccelerationMps2[100], Is.EqualTo(3f * weak.AccelerationMps2[100]).Within(1e-4f));
        }

        [Test]
        public void MotionThatNoFileGivesCanBeAddedAndReplacesNothing()
        {
            Recording bare = RecordingReader.Read(Path.Combine(Folder, "files", "no_motion.csv"));
            Assert.That(bare.KnowsMotion, Is.False);
            Assert.That((bare.VelocityAt(0), bare.ForceAt(0)), Is.EqualTo(((0.0, 0.0), 0.0)));
            Recording known = bare.With(0.2, 1.5);
            Assert.That(known.KnowsMotion, Is.True);
            Assert.That((known.VelocityAt(7), known.ForceAt(7)), Is.EqualTo(((0.2, 0.0), 1.5)));
            Recording own = RecordingReader.Read(Path.Combine(Folder, "files", "constant.csv")).With(0.5, 5.0);
            Assert.That((own.VelocityAt(7), own.ForceAt(7)), Is.EqualTo(((0.08, 0.0), 1.5)));
        }

        [Test]
        public void AGapIsNotANumberAndHasNoMotion()
        {
            Recording recording = RecordingReader.Read(Path.Combine(Folder, "files", "pause.csv"));
            Assert.That(recording.AccelerationMps2[30000], Is.NaN);
            Assert.That((recording.VelocityAt(30000), recording.ForceAt(30000)), Is.EqualTo(((0.0, 0.0), 0.0)));
            Assert.That(recording.AccelerationMps2[60400], Is.Not.NaN);
        }

        [Test]
        public void AFileThatIsNotThereIsRefusedByName()
        {
            var refusal = Assert.Throws<HaptoFlowException>(() => RecordingReader.Read("nowhere.csv"))!;
            Assert.That(refusal.Message, Does.StartWith("nowhere.csv: does not exist"));
            refusal = Assert.Throws<HaptoFlowException>(() => RecordingReader.Read("a.csv",
                new Dictionary<string, byte[]> { ["b.csv"] = Encoding.UTF8.GetBytes("time_s\n") }))!;
            Assert.That(refusal.Message, Does.StartWith("a.csv: does not exist"));
        }

        private static void AssertFigures(Recording recording, JObject answer)
        {
            int axes = recording.AxisCount;
            int[] finite = Enumerable.Range(0, recording.SampleCount)
                .Where(sample => !float.IsNaN(recording.AccelerationMps2[sample * axes])).ToArray();
            Assert.That(recording.SampleCount - finite.Length, Is.EqualTo((int)answer["missing_samples"]!));
            double[] means = Enumerable.Range(0, axes).Select(axis =>
                finite.Average(sample => (double)recording.AccelerationMps2[sample * axes + axis])).ToArray();
            double rms = Math.Sqrt(finite.Average(sample => Enumerable.Range(0, axes).Sum(axis =>
                Math.Pow(recording.AccelerationMps2[sample * axes + axis] - means[axis], 2.0))));
            double expected = (double)answer["rms_mps2"]!;
            double tolerance = ((double?)answer["tolerance"] ?? 1e-4) * expected;
            Assert.That(rms, Is.EqualTo(expected).Within(tolerance));
            for (int axis = 0; axis < axes; ++axis)
            {
                Assert.That(means[axis], Is.EqualTo((double)answer["mean_mps2"]![axis]!).Within(tolerance));
            }
            int from = (int?)answer["speed_from"] ?? 0;
            int to = Math.Min((int?)answer["speed_to"] ?? recording.SampleCount, recording.SampleCount);
            bool knowsSpeed = recording.VelocityMps != null || recording.ConstantVelocityMps != null;
            bool knowsForce = recording.ForceNewtons != null || recording.ConstantForceNewtons != null;
            // Compiled ahead of time, NUnit cannot compare two bool.
            Assert.That(knowsSpeed == (answer["speed_mps"]!.Type != JTokenType.Null));
            Assert.That(knowsForce == (answer["force_newtons"]!.Type != JTokenType.Null));
            if (knowsSpeed)
            {
                double speed = Enumerable.Range(from, to - from)
                    .Where(sample => recording.VelocityMps == null || !float.IsNaN(recording.VelocityMps[2 * sample]))
                    .Average(sample => Math.Sqrt(Math.Pow(recording.VelocityAt(sample).X, 2.0) +
                        Math.Pow(recording.VelocityAt(sample).Y, 2.0)));
                Assert.That(speed, Is.EqualTo((double)answer["speed_mps"]!).Within(1.0).Percent);
            }
            if (knowsForce)
            {
                double force = Enumerable.Range(0, recording.SampleCount)
                    .Where(sample => recording.ForceNewtons == null || !float.IsNaN(recording.ForceNewtons[sample]))
                    .Average(sample => recording.ForceAt(sample));
                Assert.That(force, Is.EqualTo((double)answer["force_newtons"]!).Within(1.0).Percent);
            }
        }
    }
}
