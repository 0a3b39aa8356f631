using System.Globalization;
using HaptoFlow.Preview;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    public sealed class AxisNumbersTests
    {
        private readonly CultureInfo culture = CultureInfo.CurrentCulture;

        [TearDown]
        public void Return() => CultureInfo.CurrentCulture = culture;

        [Test]
        public void TicksAreRoundNumbersInTheRange()
        {
            Assert.That(AxisNumbers.Ticks(0.0, 2.7, 6), Is.EqualTo(new[] { 0.0, 0.5, 1.0, 1.5, 2.0, 2.5 }).Within(1e-12));
            Assert.That(AxisNumbers.Ticks(-60.0, 10.0, 4), Is.EqualTo(new[] { -60.0, -40.0, -20.0, 0.0 }).Within(1e-12));
            Assert.That(AxisNumbers.Ticks(0.0, 0.3, 3), Is.EqualTo(new[] { 0.0, 0.1, 0.2, 0.3 }).Within(1e-12));
        }

        [TestCase(0.012, 0.02)]
        [TestCase(0.2, 0.2)]
        [TestCase(7.4, 10.0)]
        [TestCase(3.0, 5.0)]
        [TestCase(0.0, 1.0)]
        [TestCase(double.NaN, 1.0)]
        public void AxisLimitsAreRoundedUpToOneTwoOrFive(double value, double expected) =>
            Assert.That(AxisNumbers.RoundUp(value), Is.EqualTo(expected).Within(1e-12));

        [Test]
        public void NumbersAreTheSameInEveryLocale()
        {
            var comma = (CultureInfo)CultureInfo.InvariantCulture.Clone();
            comma.NumberFormat.NumberDecimalSeparator = ",";
            CultureInfo.CurrentCulture = comma;
            Assert.That(AxisNumbers.Text(-1234.5, 2), Is.EqualTo("\u22121234.5"));
            Assert.That(AxisNumbers.Text(0.25, 1), Is.EqualTo("0.3"));
            Assert.That(AxisNumbers.Fixed(1.0, 2), Is.EqualTo("1.00"));
            Assert.That(AxisNumbers.Fixed(0.12, 2, true), Is.EqualTo("+0.12"));
            Assert.That(AxisNumbers.Fixed(-0.001, 2, true), Is.EqualTo("0.00"), "zero has no sign");
            Assert.That(new LabelMix("wood", "cork", 0.25f).Title, Is.EqualTo("wood 75 % + cork 25 %"));
        }

        [Test]
        public void ABlendWithoutAShareOfTheSecondIsTheFirstAlone()
        {
            Assert.That(new LabelMix("wood", "cork", 0f), Is.EqualTo(new LabelMix("wood")));
            Assert.That(new LabelMix("wood", "", 0.5f), Is.EqualTo(new LabelMix("wood")));
            Assert.That(new LabelMix("wood", "cork", 0.5f), Is.Not.EqualTo(new LabelMix("wood")));
        }
    }
}
