using System;
using System.IO;
using System.Linq;
using System.Text;
using System.Threading;
using HaptoFlow.Model;
using HaptoFlow.Preview;
using HaptoFlow.Recordings;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    /// <summary>Recordings converted for comparison with the material learnt from them.</summary>
    public sealed class RecordingSoundTests
    {
        private static Recording Made(double rateHz, double seconds, Func<double, double[]> axes)
        {
            int count = (int)(rateHz * seconds);
            var text = new StringBuilder(axes(0.0).Length == 1
                ? "time_s,acceleration_mps2,speed_mps,force_newtons\n"
                : "time_s,acceleration_x_mps2,acceleration_y_mps2,acceleration_z_mps2,speed_mps,force_newtons\n");
            for (int index = 0; index < count; ++index)
            {
                double time = index / rateHz;
                text.Append(FormattableString.Invariant($"{time:R},{string.Join(",", axes(time).Select(axis => FormattableString.Invariant($"{axis:R}")))},0.1,1\n"));
            }
            return MadeRecordings.Table(text.ToString());
        }

        private static PreviewSound Sound(Recording recording) =>
            RecordingSound.Of(recording, RecordingSound.StrokeOf(recording));

        private static double Wave(double hertz, double seconds) => 3.0 * Math.Sin(2.0 * Math.PI * hertz * seconds);

        [TestCase(2000.0)]
        [TestCase(3333.3)]
        [TestCase(8000.0)]
        [TestCase(44100.0)]
        public void ARecordedSineKeepsItsLevelAndFrequencyWithoutGravity(double rateHz)
        {
            PreviewSound sound = Sound(Made(rateHz, 1.0, time => new[] { 9.81 + Wave(150.0, time) }));
            Assert.That(sound.Samples, Has.Length.EqualTo(48000).Within(60));
            float[] middle = sound.Samples.Skip(12000).Take(24000).ToArray();
            for (int index = 0; index < middle.Length; index += 97)
            {
                double expected = Wave(150.0, (12000 + index) / 48000.0);
                Assert.That(PreviewSound.FullScaleMps2 * middle[index], Is.EqualTo(expected).Within(0.09), $"sample {index}");
            }
        }

        [Test]
        public void FrequenciesAboveOneKilohertzAreRemoved() => Assert.That(
            Sound(Made(8000.0, 1.0, time => new[] { Wave(1600.0, time) })).RmsMps2, Is.LessThan(0.1));

        [Test]
        public void CombiningThreeAxesKeepsTheirEnergy()
        {
            var random = new Random(5);
            var noise = Enumerable.Range(0, 3).Select(_ => Enumerable.Range(0, 8000)
                .Select(each => 2.0 * random.NextDouble() - 1.0).ToArray()).ToArray();
            PreviewSound three = Sound(Made(2000.0, 4.0, time => noise
                .Select(axis => axis[Math.Min(7999, (int)Math.Round(2000.0 * time))]).ToArray()));
            double energy = noise.Sum(axis => axis.Average(value => value * value));
            // Where the axes cancel, the phases of overlapping frames differ, and overlap-add loses up to 1 dB.
            Assert.That(20.0 * Math.Log10(three.RmsMps2 / Math.Sqrt(energy)), Is.InRange(-1.5, 0.3));
        }

        [Test]
        public void VibrationOnOneOfThreeAxesIsUnchanged()
        {
            PreviewSound one = Sound(Made(2000.0, 1.0, time => new[] { Wave(90.0, time) }));
            PreviewSound three = Sound(Made(2000.0, 1.0, time => new[] { 0.0, Wave(90.0, time), 0.0 }));
            Assert.That(three.Samples.Skip(9600).Take(28800).ToArray(),
                Is.EqualTo(one.Samples.Skip(9600).Take(28800).ToArray()).Within(2e-3 / 3.0));
        }

        [Test]
        public void TheStrokeIsTheRecordedMotionOfUpToTenSeconds()
        {
            Recording recording = Made(1000.0, 12.0, time => new[] { Wave(100.0, time) });
            Stroke stroke = RecordingSound.StrokeOf(recording);
            Assert.That(stroke.DurationSeconds, Is.EqualTo(10.0).Within(0.02));
            Assert.That(stroke.States.All(state => state.Touching && state.TouchCounter == 1), Is.True);
            Assert.That(stroke.States.All(state => Math.Abs(state.VelocityXMps - 0.1) < 1e-6 && state.ForceNewtons.Equals(1.0)), Is.True);
            Assert.That(Sound(recording).DurationSeconds, Is.EqualTo(10.0).Within(0.01));
        }

        [Test]
        public void AStrokeAlongTheMaterialsAxesHasTheSpeedOfTheRecording()
        {
            Recording recording = Made(1000.0, 2.0, time => new[] { Wave(100.0, time) });
            Stroke stroke = RecordingSound.StrokeOf(recording, 90.0);
            Assert.That(stroke.States.All(state => Math.Abs(state.VelocityXMps) < 1e-6
                && Math.Abs(state.VelocityYMps + 0.1) < 1e-6), Is.True, "the recording moves along its first axis");
            Assert.That(stroke.States.All(state => state.ForceNewtons.Equals(1.0)), Is.True);
        }

        [Test]
        public void TheResultHasTheRecordingsMotionAndItsLevelIfMatched()
        {
            using var worker = new ComparisonWorker();
            Recording recording = MadeRecordings.Doormat();
            ComparisonRequest Request(string material, bool matches) => new ComparisonRequest(ModelFiles.Default, recording)
            {
                Material = material,
                MatchesLevels = matches,
            };
            ComparisonResult alone = worker.Do(Request("", false), CancellationToken.None);
            Assert.That((alone.Sounds.Count, alone.Problem), Is.EqualTo((1, (string?)null)));
            string carpet = MaterialText.OfLabel(ModelFiles.Default, "carpet");
            ComparisonResult both = worker.Do(Request(carpet, false), CancellationToken.None);
            Assert.That((both.Sounds.Count, both.Problem), Is.EqualTo((2, (string?)null)));
            Assert.That(both.Sounds[0], Is.SameAs(alone.Sounds[0]), "the recording was analysed once");
            Assert.That(both.Sounds[1].Sound.RmsMps2, Is.GreaterThan(0.01));
            ComparisonResult matched = worker.Do(Request(carpet, true), CancellationToken.None);
            Assert.That(matched.Sounds[1].Sound.RmsMps2, Is.EqualTo(matched.Sounds[0].Sound.RmsMps2).Within(0.01).Percent);
            Assert.That(matched.Sounds[1].Sound.Title, Does.Match(@"^carpet \([+-]\d+\.\d dB\)$"));
            string foreign = carpet.Replace(ModelHeader.Read(ModelFiles.Default).Space, "0badcafe");
            ComparisonResult refused = worker.Do(Request(foreign, false), CancellationToken.None);
            Assert.That((refused.Sounds.Count, refused.Problem != null), Is.EqualTo((1, true)));
        }

        [Test]
        public void TheRecordingOfTheWorkshopSampleHasMotionAndLicence()
        {
            Recording recording = MadeRecordings.Doormat();
            Assert.That((recording.AxisCount, recording.SampleCount), Is.EqualTo((3, 21000)));
            Assert.That(recording.SampleRateHz, Is.EqualTo(2000.0).Within(1e-6));
            Assert.That((recording.Label, recording.Licence, recording.KnowsMotion), Is.EqualTo(("doormat", "MIT", true)));
            Assert.That(recording.Remarks, Is.Empty);
        }
    }
}
