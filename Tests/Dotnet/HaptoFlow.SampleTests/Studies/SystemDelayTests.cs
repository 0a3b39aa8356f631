#nullable enable
using HaptoFlow.Studies;
using NUnit.Framework;

namespace HaptoFlow.SampleTests
{
    /// <summary>The delay that must be added to the system's for a delay level.</summary>
    public sealed class SystemDelayTests
    {
        private static readonly SystemDelay System = new SystemDelay(13.9, 0.0, 10.7, 5.0);

        [Test]
        public void TheArtificialDelayIsWhatRemainsAfterTheFourParts()
        {
            Assert.That(System.TotalMilliseconds, Is.EqualTo(29.6).Within(1e-12));
            Assert.That(System.ArtificialMilliseconds(50.0), Is.EqualTo(20.4).Within(1e-12));
            Assert.That(System.ArtificialMilliseconds(System.TotalMilliseconds), Is.Zero);
        }

        [Test]
        public void UnreachableLevelsAreRefusedWithThePartsOfTheSystemDelay()
        {
            var slow = new SystemDelay(13.9, 0.0, 21.3, 25.0);
            Assert.That(() => slow.CheckReaches(new[] { 50.0, 60.0, 70.0, 570.0 }), Throws.TypeOf<StudyException>().With
                .Message.Contains("level 50, 60, 570 ms cannot be reached").And
                .Message.Contains("60.2 ms (pose interval 13.9 + inference 0.0 + block 21.3 + device 25.0)").And
                .Message.Contains("levels_ms"));
            Assert.That(() => slow.CheckReaches(new[] { 70.0, 560.0 }), Throws.Nothing);
            Assert.That(() => slow.ArtificialMilliseconds(50.0), Throws.TypeOf<StudyException>());
        }

        [TestCase(double.NaN)]
        [TestCase(-1.0)]
        [TestCase(double.PositiveInfinity)]
        public void AnInvalidPartIsRefusedByName(double milliseconds) => Assert.That(
            () => new SystemDelay(1.0, 1.0, 1.0, milliseconds),
            Throws.TypeOf<StudyException>().With.Message.StartsWith("device_ms"));

        [Test]
        public void ALateFrameDoesNotChangeThePoseInterval()
        {
            var interval = new PoseInterval();
            for (int frame = 0; frame < 200; ++frame)
            {
                interval.Add(frame % 10 == 9 ? 0.5 : 1.0 / 72.0);
            }
            interval.Add(double.NaN);
            interval.Add(-3.0);
            interval.Add(1e9);
            Assert.That(interval.MedianMilliseconds, Is.EqualTo(1000.0 / 72.0).Within(1e-9));
        }
    }
}
