using System;
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

        private static HapticLearning Start(Recording recording, string name = "doormat") =>
            HapticLearning.Start(Model, recording, new LearningOptions
            {
                Name = name,
                Category = "cloth",
                Description = "A mat.",
                Licence = recording.Licence,
                SecondsLimit = Quickly,
            });

        /// <summary>Creates a table of a wave with a duration and a sample rate.</summary>
        private static Recording Table(double rateHz, double seconds, Func<double, string> row, string columns)
        {
            var text = new StringBuilder("time_s," + columns + "\n");
            for (int index = 0; index < (int)(rateHz * seconds); ++index)
            {
                text.Append(FormattableString.Invariant($"{index / rateHz:R},")).Append(row(index / rateHz)).Append('\n');
            }
            return MadeRecordings.Table(text.ToString());
        }

        private static string Noise(Random random, double time)
        {
            double speed = 0.07 + 0.05 * Math.Sin(2.1 * time);
            return FormattableString.Invariant($"{30.0 * speed * (2.0 * random.NextDouble() - 1.0):R},{speed:R},1.1");
        }

        [TearDown]
        public void EndAll() => HapticLearning.EndAll();

        [Test]
        public void ALearntMaterialHasNameLicenceAndSpaceAndAnEngineAcceptsIt()
        {
            using HapticLearning learning = Start(MadeRecordings.Doormat());
            learning.Wait();
            Assert.That(learning.Problem, Is.Null);
            Assert.That(learning.IsCancelled, Is.False);
            Assert.That(learning.IsCompleted, Is.True);
            MaterialFile material = MaterialFile.Read(learning.Material!);
            Assert.That((material.Name, material.Category, material.Description, material.Licence, material.Space),
                Is.EqualTo(("doormat", "cloth", "A mat.", "MIT", ModelHeader.Read(Model).Space)));
            Assert.That(material.Seconds, Is.GreaterThan(1.0));
            Assert.That(ModelHeader.Read(Model).Labels.Select(label => label.Name), Does.Contain(learning.NearestLabel));
            Assert.That(JsonValue.Parse(learning.Report!.Trim())["seconds"].AsNumber(), Is.GreaterThan(0.0));
            using OnnxRuntime runtime = OnnxRuntime.Open();
            using HapticModel model = HapticModel.Open(Model);
            using var engine = new HapticEngine(runtime, model,
                new HapticEngineOptions { Quality = HapticQuality.Draft, WithoutWorker = true, FixedLeadMs = 8.0 });
            Assert.That(engine.RegisterMaterial(learning.Material!), Is.EqualTo(model.Labels.Count));
        }

        [Test]
        public void ProgressIsReportedWhileTheCallerContinues()
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
        }

        [Test]
        public void ACancelledLearningEndsWithoutMaterialOrProblem([Values(0, 30, 300)] int milliseconds)
        {
            using HapticLearning learning = HapticLearning.Start(Model, MadeRecordings.Doormat(), new LearningOptions { Name = "doormat" });
            Thread.Sleep(milliseconds);
            learning.Cancel();
            learning.Cancel();
            learning.Wait();
            Assert.That(learning.IsCancelled, Is.True);
            Assert.That((learning.Problem, learning.Material, learning.NearestLabel),
                Is.EqualTo(((string?)null, (string?)null, "")));
            learning.Cancel();
        }

        [Test]
        public void TwoLearningsRunAtOnceAndTheSameSeedGivesTheSameBytes()
        {
            // No time limit here: a fit that ends at its limit is not reproducible.
            var options = new LearningOptions { Name = "one", SecondsLimit = 120.0 };
            using HapticLearning one = HapticLearning.Start(Model, MadeRecordings.Doormat(), options);
            using HapticLearning other = HapticLearning.Start(Model, MadeRecordings.Doormat(), options);
            one.Wait();
            other.Wait();
            Assert.That((one.Problem, other.Problem), Is.EqualTo(((string?)null, (string?)null)));
            Assert.That(other.Material, Is.EqualTo(one.Material));
        }

        [Test]
        public void CancellingOneLearningDoesNotCancelTheOther()
        {
            using HapticLearning one = Start(MadeRecordings.Doormat(), "one");
            using HapticLearning other = Start(MadeRecordings.Doormat(), "other");
            one.Cancel();
            one.Wait();
            other.Wait();
            Assert.That(one.IsCancelled, Is.True);
            Assert.That(MaterialFile.Read(other.Material!).Name, Is.EqualTo("other"));
        }

        [Test]
        public void EndAllWaitsForAllLearningsAndLaterOnesCanStart()
        {
            HapticLearning[] all = Enumerable.Range(0, 3).Select(number => Start(MadeRecordings.Doormat(), "m" + number)).ToArray();
            HapticLearning.EndAll();
            Assert.That(all.All(each => each.IsCompleted), Is.True);
            using HapticLearning later = Start(MadeRecordings.Doormat());
            later.Wait();
            Assert.That(later.Problem, Is.Null);
        }

        [TestCase(1000.0)]
        [TestCase(5000.0)]
        [TestCase(48000.0)]
        public void RecordingsWithOtherSampleRatesAreAccepted(double rateHz)
        {
            var random = new Random(3);
            Recording recording = Table(rateHz, 11.0, time => Noise(random, time), "acceleration_mps2,speed_mps,force_newtons");
            using HapticLearning learning = Start(recording, "noise");
            learning.Wait();
            Assert.That(learning.Problem, Is.Null);
        }

        [Test]
        public void EnteredSpeedAndForceReplaceMissingOnes()
        {
            var random = new Random(3);
            Recording recording = Table(2000.0, 11.0, time => FormattableString.Invariant(
                $"{3.0 * (2.0 * random.NextDouble() - 1.0):R}"), "acceleration_mps2");
            Assert.Throws<ArgumentException>(() => Start(recording));
            using HapticLearning learning = Start(recording.With(0.08, 1.0), "noise");
            learning.Wait();
            Assert.That(learning.Problem, Is.Null);
        }

        [Test]
        public void AShortOrRestingRecordingIsRefusedWithTheReason()
        {
            var random = new Random(3);
            const string columns = "acceleration_mps2,speed_mps,force_newtons";
            using HapticLearning tooShort = Start(Table(2000.0, 1.0, time => Noise(random, time), columns));
            tooShort.Wait();
            Assert.That(tooShort.Problem, Is.Not.Null.And.Not.Empty);
            using HapticLearning atRest = Start(Table(2000.0, 11.0, time => FormattableString.Invariant(
                $"{random.NextDouble():R},0,1"), columns));
            atRest.Wait();
            Assert.That(atRest.Problem, Is.Not.Null.And.Not.Empty.And.Not.EqualTo(tooShort.Problem));
        }

        [Test]
        public void InvalidArgumentsAreRefusedAtOnceAndADamagedModelAtTheEnd()
        {
            Assert.Throws<ArgumentException>(() => Start(MadeRecordings.Doormat(), " "));
            Assert.Throws<ArgumentException>(() => HapticLearning.Start(Model, MadeRecordings.Doormat(),
                new LearningOptions { Name = "a", WaveVectorsPerMillimetre = new float[3] }));
            byte[] damaged = (byte[])Model.Clone();
            damaged[100] ^= 1;
            using HapticLearning learning = HapticLearning.Start(damaged, MadeRecordings.Doormat(), new LearningOptions { Name = "a" });
            learning.Wait();
            Assert.That(learning.Problem, Does.Contain("checksum"));
        }

        [Test]
        public void StartingALearningDoesNotBlockTheCaller()
        {
            Recording recording = MadeRecordings.Doormat();
            using HapticLearning first = Start(recording);
            Assert.That(first.IsCompleted, Is.False, "the learning continues after Start has returned");
            first.Cancel();
        }
    }
}
