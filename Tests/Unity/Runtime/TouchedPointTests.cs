#nullable enable
using HaptoFlow.Alignment;
using HaptoFlow.Numerics;
using NUnit.Framework;

namespace HaptoFlow.Tests
{
    public sealed class TouchedPointTests
    {
        private TouchedPoint point = null!;
        private double now;

        [SetUp]
        public void TakeAPen()
        {
            point = new TouchedPoint();
            now = 0.0;
        }

        [Test]
        public void ARestingPenGivesItsMeanPositionOncePerRest()
        {
            int taken = 0;
            Double3 found = default;
            for (int frame = 0; frame < 90; ++frame)
            {
                var place = new Double3(1.0 + 0.001 * (frame % 2 == 0 ? 1.0 : -1.0), 2.0, 3.0);
                if (point.Update(now += 1.0 / 90.0, place, true, out Double3 mean))
                {
                    ++taken;
                    found = mean;
                }
            }
            Assert.That(taken, Is.EqualTo(1));
            Assert.That(Double3.Distance(found, new Double3(1.0, 2.0, 3.0)), Is.LessThan(1e-4));
            Assert.That(Rest(new Double3(1.0, 2.0, 3.0)), Is.False, "the pen was not lifted");
            point.Update(now += 0.01, default, false, out _);
            Assert.That(Rest(new Double3(1.0, 2.0, 3.0)), Is.True);
        }

        [Test]
        public void APenThatMovesOrHoversTakesNoPoint()
        {
            for (int frame = 0; frame < 180; ++frame)
            {
                var moving = new Double3(0.05 * now, 0.0, 0.0);
                Assert.That(point.Update(now += 1.0 / 90.0, moving, true, out _), Is.False);
            }
            for (int frame = 0; frame < 180; ++frame)
            {
                Assert.That(point.Update(now += 1.0 / 90.0, Double3.Zero, false, out _), Is.False);
            }
        }

        [Test]
        public void AnInvalidSampleRestartsTheRest()
        {
            for (int frame = 0; frame < 20; ++frame)
            {
                point.Update(now += 1.0 / 90.0, Double3.Zero, true, out _);
            }
            point.Update(now, new Double3(double.NaN, 0.0, 0.0), true, out _);
            Assert.That(point.Update(now += 0.2, Double3.Zero, true, out _), Is.False);
        }

        [Test]
        public void APressBeforeTheFirstLiftTakesNoPoint()
        {
            point.AwaitLift();
            Assert.That(Rest(Double3.Zero), Is.False);
        }

        private bool Rest(Double3 place)
        {
            bool taken = false;
            for (int frame = 0; frame < 60; ++frame)
            {
                taken |= point.Update(now += 1.0 / 90.0, place, true, out _);
            }
            return taken;
        }
    }
}
