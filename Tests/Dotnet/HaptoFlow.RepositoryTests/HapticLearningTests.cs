using System;
using System.IO;
using System.Linq;
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

        [Test]
        public void ADamagedModelIsRefusedAtTheEnd()
        {
            byte[] damaged = (byte[])Model.Clone();
            damaged[100] ^= 1;
            using HapticLearning learning =
                HapticLearning.Start(damaged, MadeRecordings.Doormat(), new LearningOptions());
            learning.Wait();
            Assert.That(learning.Problem, Does.Contain("checksum"));
        }
    }
}
