using System;
using System.Collections.Generic;
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using NUnit.Framework;

namespace HaptoFlow.RepositoryTests
{
    /// <summary>The tip's velocity on a surface at rest. The golden contact states hold the same arithmetic to the
    /// native one.</summary>
    public sealed class VelocityTests
    {
        private TipPath path = NewPath();
        private readonly RelativeVelocity relative = new RelativeVelocity();

        [SetUp]
        public void Restart()
        {
            path = NewPath();
        }

        [TestCase(72.0)]
        [TestCase(90.0)]
        [TestCase(120.0)]
        [TestCase(1000.0)]
        public void AnAcceleratedTipHasTheVelocityOfNow(double rateHz)
        {
            List<double> speeds = SpeedsOf(0.5, rateHz, time => new Double3(time * time, 0.0, 0.0));
            double lagSeconds = (speeds.Count - 1) / rateHz - speeds[^1] / 2.0;
            Assert.That(lagSeconds, Is.EqualTo(0.0).Within(0.001));
        }

        [TestCase(72.0)]
        [TestCase(120.0)]
        [TestCase(1000.0)]
        public void ATrackersNoiseOfATenthOfAMillimetreAtRestIsBelowEightMillimetresASecond(double rateHz)
        {
            var random = new Random(3);
            List<double> speeds = SpeedsOf(10.0, rateHz, _ => Noise(random, 1e-4));
            double squares = 0.0;
            int first = speeds.Count / 10;
            for (int frame = first; frame < speeds.Count; ++frame)
            {
                squares += speeds[frame] * speeds[frame];
            }
            Assert.That(Math.Sqrt(squares / (speeds.Count - first)), Is.LessThan(0.008));
        }

        [TestCase(72.0)]
        [TestCase(1000.0)]
        public void ATrackerThatNeverRepeatsItselfHasStoppedAfterTwoFrames(double rateHz)
        {
            List<double> speeds = SpeedsOf(1.0, rateHz, time => new Double3(0.5 * Math.Min(time, 0.7), 0.0, 0.0));
            for (int frame = (int)Math.Ceiling(0.7 * rateHz + 2.5); frame < speeds.Count; ++frame)
            {
                Assert.That(speeds[frame], Is.Zero, $"frame {frame}");
            }
        }

        [Test]
        public void SixtyHertzTrackingInNinetyHertzFramesIsSlowAndNotFlattened()
        {
            List<double> speeds = SpeedsOf(6.0, 90.0, time =>
                new Double3(0.3 * Math.Floor(60.0 * time + 0.2) / 60.0, 0.0, 0.0));
            double sum = 0.0;
            speeds.GetRange(90, speeds.Count - 90).ForEach(speed => sum += speed);
            Assert.That(path.IsSlow, Is.True);
            Assert.That(sum / (speeds.Count - 90), Is.EqualTo(0.3).Within(0.003));
        }

        [Test]
        public void AKilometreFromTheOriginNothingChanges()
        {
            var far = new Double3(1000.0, -1000.0, 1000.0);
            Func<double, Double3> Path(Double3 origin)
            {
                var random = new Random(4);
                return time => origin + new Double3(0.01 * Math.Sin(18.0 * time), 0.0, 0.0) + Noise(random, 1e-4);
            }
            List<double> near = SpeedsOf(5.0, 90.0, Path(Double3.Zero));
            Restart();
            List<double> distant = SpeedsOf(5.0, 90.0, Path(far));
            for (int frame = 0; frame < near.Count; ++frame)
            {
                Assert.That(distant[frame], Is.EqualTo(near[frame]).Within(1e-6), $"frame {frame}");
            }
        }

        [Test]
        public void WhateverTheTrackerSaysTheVelocityIsFiniteAndNoFasterThanTheLimit()
        {
            var random = new Random(5);
            double time = 0.0;
            Double3 place = Double3.Zero;
            for (int frame = 0; frame < 50000; ++frame)
            {
                time += Math.Pow(10.0, -4.0 + 3.0 * random.NextDouble());
                if (random.Next(3) != 0)
                {
                    place += Noise(random, Math.Pow(10.0, -9.0 + 8.0 * random.NextDouble()));
                }
                path.Add(time, place, place);
                TipVelocity velocity = relative.Of(path);
                Assert.That(velocity.NowMps.Length, Is.LessThanOrEqualTo(20.0 * (1.0 + 1e-12)));
                Assert.That(velocity.ApproachMps.Length, Is.LessThanOrEqualTo(20.0 * (1.0 + 1e-12)));
            }
        }

        [Test]
        public void NoFrameAllocates()
        {
            var random = new Random(6);
            var places = new Double3[2000];
            for (int frame = 0; frame < places.Length; ++frame)
            {
                places[frame] = new Double3(0.01 * Math.Sin(0.2 * frame), 0.0, 0.0) + Noise(random, 1e-4);
            }
            Follow(places);
            Restart();
            long before = GC.GetAllocatedBytesForCurrentThread();
            Follow(places);
            Assert.That(GC.GetAllocatedBytesForCurrentThread() - before, Is.Zero);
        }

        private void Follow(Double3[] places)
        {
            for (int frame = 0; frame < places.Length; ++frame)
            {
                path.Add(frame / 500.0, places[frame], places[frame]);
                relative.Of(path);
            }
        }

        private static TipPath NewPath() => new TipPath(new VelocitySettings(), new TrackerNoise());

        private List<double> SpeedsOf(double seconds, double rateHz, Func<double, Double3> stroke)
        {
            var speeds = new List<double>();
            for (int frame = 0; frame / rateHz <= seconds; ++frame)
            {
                Double3 place = stroke(frame / rateHz);
                path.Add(frame / rateHz, place, place);
                speeds.Add(relative.Of(path).NowMps.Length);
            }
            return speeds;
        }

        private static Double3 Noise(Random random, double metres)
        {
            double One()
            {
                double sum = -6.0;
                for (int part = 0; part < 12; ++part)
                {
                    sum += random.NextDouble();
                }
                return metres * sum;
            }
            return new Double3(One(), One(), One());
        }
    }
}
