using System;
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using NUnit.Framework;

namespace HaptoFlow.RepositoryTests
{
    /// <summary>What C# adds to the tip's velocity. The golden contact states hold the arithmetic to the native one, whose
    /// tests say what it does.</summary>
    public sealed class VelocityTests
    {
        private TipPath path = NewPath();
        private readonly RelativeVelocity relative = new RelativeVelocity();

        [SetUp]
        public void Restart()
        {
            path = NewPath();
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
        public void AnEndSpeedBeyondTheLimitIsTheLimit()
        {
            Double3 place = Double3.Zero;
            for (int frame = 0; frame < 9; ++frame)
            {
                // Each step as fast as allowed, and faster than the one before by as much as a hand can.
                place += new Double3((19.9 - 2.4 * (8 - frame)) / 90.0, 0.0, 0.0);
                path.Add(frame / 90.0, place, place);
            }
            Assert.That(relative.Of(path).NowMps.X, Is.EqualTo(20.0).Within(1e-9));
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

        private static TipPath NewPath() => new TipPath(new TrackerNoise());

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
