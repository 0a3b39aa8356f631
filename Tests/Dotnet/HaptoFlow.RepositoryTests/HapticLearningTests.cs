using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Text;
using System.Threading;
using HaptoFlow.Model;
using HaptoFlow.Recordings;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

namespace HaptoFlow.RepositoryTests
{
    /// <summary>Learning a material from C# with the real library: progress, cancelling, two at once, refusals.
    /// </summary>
    public sealed class HapticLearningTests
    {
        // A short time limit, because these tests do not measure the quality of the fit.
        private const double Quickly = 0.5;

        private static readonly byte[] Model = File.ReadAllBytes(RepositoryFiles.DefaultModel);

        // Read faster than a real recording.
        private static readonly Recording Short = Noise().With(0.08, 1.0);

        /// <summary>Eleven seconds of noise without motion.</summary>
        private static Recording Noise()
        {
            var random = new Random(3);
            return MadeRecordings.Table("time_s,acceleration_mps2\n" + string.Concat(
                Enumerable.Range(0, 22000).Select(index => FormattableString.Invariant(
                    $"{index / 2000.0:R},{6.0 * random.NextDouble() - 3.0:R}\n"))));
        }

        private static HapticLearning Start(Recording recording, string name = "") =>
            HapticLearning.Start(Model, recording, new LearningOptions
            {
                Name = name,
                Category = "cloth",
                Description = "A mat.",
                SecondsLimit = Quickly,
            });

        [TearDown]
        public void EndAll() => HapticLearning.EndAll();

        [Test]
        public void ALearntMaterialHasTheRecordingsWordsAndTheModelsSpaceAndTellsItsProgress()
        {
            using HapticLearning learning = Start(MadeRecordings.Doormat());
            float before = 0f;
            bool hasReportedStep = false;
            while (!learning.IsCompleted)
            {
                float share = learning.Share;
                Assert.That(share, Is.InRange(before, 1f));
                before = share;
                hasReportedStep |= learning.Doing.Length > 0;
                Thread.Sleep(1);
            }
            Assert.That(hasReportedStep, Is.True);
            Assert.That(learning.Problem, Is.Null);
            Assert.That(learning.IsCancelled, Is.False);
            MaterialFile material = MaterialFile.Read(learning.Material!);
            Assert.That((material.Name, material.Category, material.Description, material.Licence, material.Space),
                Is.EqualTo(("doormat", "cloth", "A mat.", "MIT", ModelHeader.Read(Model).Space)));
            using HapticModel model = HapticModel.Open(Model);
            Assert.That(learning.NearestLabel, Is.EqualTo(model.NearestLabel(material.Embedding)));
            Assert.That(JsonValue.Parse(learning.Report!.Trim())["seconds"].AsNumber(), Is.GreaterThan(0.0));
        }

        [Test]
        public void ACancelledLearningEndsWithoutMaterialOrProblem([Values(0, 300)] int milliseconds)
        {
            using HapticLearning learning =
                HapticLearning.Start(Model, MadeRecordings.Doormat(), new LearningOptions());
            Assert.That(learning.IsCompleted, Is.False, "the learning continues after Start has returned");
            Thread.Sleep(milliseconds);
            learning.Cancel();
            learning.Cancel();
            learning.Wait();
            Assert.That(learning.IsCancelled, Is.True);
            Assert.That(learning.Problem ?? learning.Material, Is.Null);
            Assert.That(learning.NearestLabel, Is.Empty);
            learning.Cancel();
        }

        [Test]
        public void CancellingOneLearningDoesNotCancelTheOther()
        {
            using HapticLearning one = Start(Short, "one");
            using HapticLearning other = Start(Short, "other");
            one.Cancel();
            one.Wait();
            other.Wait();
            Assert.That(one.IsCancelled, Is.True);
            Assert.That(MaterialFile.Read(other.Material!).Name, Is.EqualTo("other"));
        }

        [Test]
        public void EndAllWaitsForAllLearningsAndLaterOnesCanStart()
        {
            HapticLearning[] all =
                Enumerable.Range(0, 3).Select(number => Start(Short, "m" + number)).ToArray();
            HapticLearning.EndAll();
            Assert.That(all.All(each => each.IsCompleted), Is.True);
            using HapticLearning later = Start(Short);
            later.Wait();
            Assert.That(later.Problem, Is.Null);
        }

        [Test]
        public void EnteredSpeedAndForceReplaceMissingOnes()
        {
            using HapticLearning without = Start(Noise());
            without.Wait();
            Assert.That(without.Problem, Does.StartWith("made.csv: no motion in it or beside it"));
            using HapticLearning learning = Start(Short);
            learning.Wait();
            Assert.That(learning.Problem, Is.Null);
        }
    }

    /// <summary>Recordings as C# gets them from the native reader: files on disk and of an application, and what the
    /// wrapper adds.</summary>
    public sealed class RecordingReaderTests
    {
        private static readonly string Folder = RepositoryFiles.In("Tests", "Golden", "recordings", "files");

        [Test]
        public void FilesOfAnApplicationAreReadByTheirNames()
        {
            Dictionary<string, byte[]> files = Directory.GetFiles(MadeRecordings.DoormatFolder, "doormat*").ToDictionary(
                path => Path.GetFileName(path).Replace(".bytes", ""), File.ReadAllBytes);
            Recording recording = RecordingReader.Read("doormat.wav", files);
            Assert.That((recording.Name, recording.Label, recording.MaterialName, recording.Licence),
                Is.EqualTo(("doormat", "doormat", "doormat", "MIT")));
            Assert.That((recording.AxisCount, recording.SampleCount), Is.EqualTo((3, 21000)));
            Assert.That(recording.KnowsMotion, Is.True, "sidecar and motion file were found");
            Assert.That(recording.SampleRateHz, Is.EqualTo(2000.0).Within(1e-6));
            Assert.That(recording.Remarks, Is.Empty);
            files.Remove("doormat.motion.csv");
            var refusal = Assert.Throws<HaptoFlowException>(() => RecordingReader.Read("doormat.wav", files))!;
            Assert.That(refusal.Status, Is.EqualTo(HaptoFlowStatus.RecordingUnusable));
            Assert.That(refusal.Message, Does.Contain("doormat.motion.csv, which is not there"));
        }

        [Test]
        public void TheFullScaleOfAWavCanBeGiven()
        {
            string path = Path.Combine(Folder, "wave_alone.wav");
            float[] weak = RecordingReader.Read(path, 10.0).Wave(1.0);
            float[] strong = RecordingReader.Read(path, 30.0).Wave(1.0);
            Assert.That(weak.Max(), Is.GreaterThan(0f));
            Assert.That(strong, Is.EqualTo(weak.Select(sample => 3f * sample)).Within(1e-3f));
        }

        [Test]
        public void MotionThatNoFileGivesCanBeAddedAndReplacesNothing()
        {
            Recording bare = RecordingReader.Read(Path.Combine(Folder, "no_motion.csv"));
            Assert.That(bare.KnowsMotion, Is.False);
            Assert.That((bare.VelocityAt(0), bare.ForceAt(0)), Is.EqualTo(((0.0, 0.0), 0.0)));
            Recording known = bare.With(0.2, 1.5);
            Assert.That(known.KnowsMotion, Is.True);
            Assert.That((known.VelocityAt(7), known.ForceAt(7)), Is.EqualTo(((0.2, 0.0), 1.5)));
            Recording own = RecordingReader.Read(Path.Combine(Folder, "constant.csv")).With(0.5, 5.0);
            Assert.That((own.VelocityAt(7), own.ForceAt(7)), Is.EqualTo(((0.08, 0.0), 1.5)));
        }

        [Test]
        public void AGapHasNoMotionAndBeyondTheEndThereIsNone()
        {
            Recording recording = RecordingReader.Read(Path.Combine(Folder, "pause.csv"));
            Assert.That((recording.VelocityAt(30000), recording.ForceAt(30000)), Is.EqualTo(((0.0, 0.0), 0.0)));
            Assert.That(recording.VelocityAt(100).X, Is.GreaterThan(0.0));
            Assert.Throws<System.ArgumentOutOfRangeException>(() => recording.ForceAt(recording.SampleCount));
        }
    }
}
