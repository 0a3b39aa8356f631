#nullable enable
using HaptoFlow.Editor;
using NUnit.Framework;

namespace HaptoFlow.EditorTests
{
    public sealed class LevelMeterTests
    {
        [TestCase(1f, 0.0)]
        [TestCase(0.1f, -20.0)]
        [TestCase(0.001f, -60.0)]
        [TestCase(1e-9f, -60.0)]
        [TestCase(0f, -60.0)]
        public void ALevelIsShownInDecibelsOfFullScale(float level, double decibels) =>
            Assert.That(LevelMeter.DecibelsOf(level), Is.EqualTo(decibels).Within(1e-4));

        [TestCase(0.0, 1f)]
        [TestCase(-30.0, 0.5f)]
        [TestCase(-60.0, 0f)]
        public void TheBarRangesFromMinusSixtyDecibelsToFullScale(double decibels, float share) =>
            Assert.That(LevelMeter.ShareOf(decibels), Is.EqualTo(share).Within(1e-6f));

        [Test]
        public void CaptionsAreCreatedOnce()
        {
            Assert.That(LevelMeter.CaptionOf(-12.4), Is.SameAs(LevelMeter.CaptionOf(-11.6)));
            Assert.That(LevelMeter.CaptionOf(-12.4), Is.EqualTo("level -12 dB of full scale"));
            Assert.That(LevelMeter.CaptionOf(-60.0), Is.EqualTo("silent"));
            Assert.That(LevelMeter.CaptionOf(0.0), Is.EqualTo("level 0 dB of full scale"));
        }
    }
}
