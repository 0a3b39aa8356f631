using System;
using System.IO;
using System.Linq;
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
        /// <summary>A sine of 3 m/s^2 at 150 Hz on gravity, with a constant motion.</summary>
        private static Recording Made(double rateHz, double seconds) => MadeRecordings.Table(
            "time_s,acceleration_mps2,speed_mps,force_newtons\n" + string.Concat(
                Enumerable.Range(0, (int)(rateHz * seconds)).Select(index => FormattableString.Invariant(
                    $"{index / rateHz:R},{9.81 + Wave(index / rateHz):R},0.1,1\n"))));

        private static PreviewSound Sound(Recording recording) =>
            RecordingSound.Of(recording, RecordingSound.StrokeOf(recording));

        private static double Wave(double seconds) => 3.0 * Math.Sin(2.0 * Math.PI * 150.0 * seconds);

        [TestCase(2000.0)]
        [TestCase(3333.3)]
        public void ARecordedSineKeepsItsLevelAndFrequencyWithoutGravity(double rateHz)
        {
            PreviewSound sound = Sound(Made(rateHz, 1.0));
            Assert.That(sound.Samples, Has.Length.EqualTo(48000).Within(60));
            float[] middle = sound.Samples.Skip(12000).Take(24000).ToArray();
            for (int index = 0; index < middle.Length; index += 97)
            {
                double expected = Wave((12000 + index) / 48000.0);
                Assert.That(PreviewSound.FullScaleMps2 * middle[index], Is.EqualTo(expected).Within(0.09), $"sample {index}");
            }
        }

        [Test]
        public void TheStrokeIsTheRecordedMotionOfUpToTenSeconds()
        {
            Recording recording = Made(1000.0, 12.0);
            Stroke stroke = RecordingSound.StrokeOf(recording);
            Assert.That(stroke.DurationSeconds, Is.EqualTo(10.0).Within(0.02));
            Assert.That(stroke.States.All(state => state.Touching && state.TouchCounter == 1), Is.True);
            Assert.That(stroke.States.All(state => Math.Abs(state.VelocityXMps - 0.1) < 1e-6 && state.ForceNewtons.Equals(1.0)), Is.True);
            Assert.That(Sound(recording).DurationSeconds, Is.EqualTo(10.0).Within(0.01));
        }

        [Test]
        public void AStrokeAlongTheMaterialsAxesHasTheSpeedOfTheRecording()
        {
            Recording recording = Made(1000.0, 2.0);
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
    }
}
