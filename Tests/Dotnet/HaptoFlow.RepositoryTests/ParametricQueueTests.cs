#nullable enable
using System;
using System.Linq;
using HaptoFlow.Outputs;
using NUnit.Framework;
using static HaptoFlow.RepositoryTests.Playback;

namespace HaptoFlow.RepositoryTests
{
    /// <summary>The stream of a simulated device that plays amplitude and frequency over time. The device throws if a
    /// rule of streams is violated.</summary>
    public sealed class ParametricQueueTests
    {
        [Test]
        public void TheQueueNeitherStarvesNorGrowsInAMinute(
            [Values(0.0, 45.0, 100.0)] double rateHz, [Values(-0.005, 0.0, 0.005)] double drift)
        {
            var device = new SimulatedParametricDevice { RateHz = rateHz, Drift = drift };
            var queue = new ParametricQueue(device, SimulatedWave.Sine(150.0));
            var random = new Random(3);
            double now = 0.0;
            double deepest = 0.0;
            for (int frame = 0; now < 60.0; ++frame)
            {
                now += FrameSeconds * (0.85 + 0.3 * random.NextDouble());
                device.AdvanceTo(now);
                Assert.That(device.IsStarved && frame > 20, Is.False, $"starved at {now} s");
                queue.Update(now);
                deepest = Math.Max(deepest, device.DepthSeconds);
            }
            Assert.That(deepest, Is.LessThan(0.035 + (rateHz > 0.0 ? 1.0 / rateHz : 0.0)));
            Assert.That(queue.Statistics.Gaps, Is.Zero);
        }

        [Test]
        public void EveryIntervalOf8MillisecondsHasTheIntensityOfTheWave()
        {
            static double Envelope(double seconds) => 0.4 + 0.3 * Math.Sin(2.0 * Math.PI * 6.0 * seconds);
            var device = new SimulatedParametricDevice();
            var queue = new ParametricQueue(device, new SimulatedWave(seconds =>
                Envelope(seconds) * Math.Sin(2.0 * Math.PI * 250.0 * seconds)));
            double now = 0.0;
            double worst = 0.0;
            double began = double.NaN;
            for (int frame = 0; frame < 200; ++frame)
            {
                now = frame * FrameSeconds;
                device.AdvanceTo(now);
                queue.Update(now);
                began = double.IsNaN(began) && queue.IsPlaying ? now - FrameSeconds : began;
                for (double at = now; at < now + FrameSeconds && now > 0.2; at += 0.008)
                {
                    // The wave begins a frame before its stream, an amplitude is that of the previous 5 ms, and the
                    // low-pass of the features delays by 1.5 ms.
                    double expected = Envelope(at - began - FrameSeconds - 0.5 * ParametricQueue.PointSeconds - 0.0015);
                    worst = Math.Max(worst, Math.Abs(device.AmplitudeAt(at) - expected));
                }
            }
            TestContext.WriteLine($"worst deviation {worst:0.000}");
            Assert.That(worst, Is.LessThan(0.16));
            Assert.That(device.LastFrequency, Is.EqualTo((250.0 - 50.0) / 400.0).Within(0.05));
        }

        [Test]
        public void AnOnsetIsPlayedAsATransient()
        {
            var device = new SimulatedParametricDevice();
            Play(device, new ParametricQueue(device, new SimulatedWave(seconds => seconds % 0.5 < 0.25
                ? 0.02 * Math.Sin(1000.0 * seconds) : 0.6 * Math.Sin(1000.0 * seconds))), 0.0, 2.0);
            Assert.That(device.Knocks.Count, Is.InRange(3, 8));
            Assert.That(device.Knocks.Count(knock => knock.Amplitude > 0.35f), Is.InRange(3, 4), "one for each onset");
        }

        [Test]
        public void AStreamBeginsFromSilenceAfterAHitch()
        {
            var device = new SimulatedParametricDevice();
            var queue = new ParametricQueue(device, SimulatedWave.Sine(150.0));
            double now = Play(device, queue, 0.0, 1.0);
            Assert.That(device.AmplitudeAt(now + 0.1), Is.Zero, "a stream that gets nothing more ends by itself");
            now += 0.2;
            device.AdvanceTo(now);
            queue.Update(now);
            Assert.That(device.AmplitudeAt(now), Is.Zero);
            Assert.That(device.AmplitudeAt(now + 0.01), Is.EqualTo(0.3f).Within(0.05f));
            Assert.That(queue.Statistics.Gaps, Is.EqualTo(1));
        }

        [Test]
        public void AStopReachesTheDeviceInTheSameFrameAndSilenceEndsTheStream()
        {
            var device = new SimulatedParametricDevice();
            SimulatedWave wave = SimulatedWave.Sine(150.0);
            var queue = new ParametricQueue(device, wave);
            double now = Play(device, queue, 0.0, 1.0);
            wave.IsStopped = true;
            device.AdvanceTo(now);
            queue.Update(now);
            Assert.That(device.AmplitudeAt(now), Is.Zero);
            wave.IsStopped = false;
            now = Play(device, queue, now, 0.5);
            wave.IsSilent = true;
            now = Play(device, queue, now, 0.1);
            int before = device.Submissions;
            Assert.That(device.AmplitudeAt(now), Is.Zero);
            Play(device, queue, now, 0.5);
            Assert.That(device.Submissions, Is.EqualTo(before));
            Assert.That(queue.IsPlaying, Is.False);
        }

        [Test]
        public void RandomStrokesHitchesStopsAndLossesObeyTheRulesOfStreams([Range(1, 4)] int seed)
        {
            var random = new Random(seed);
            var device = new SimulatedParametricDevice { Drift = 0.01 * (random.NextDouble() - 0.5) };
            SimulatedWave wave = SimulatedWave.Sine(90.0, 0.9);
            var queue = new ParametricQueue(device, wave);
            queue.Gain = 3f;
            double now = 0.0;
            for (int frame = 0; frame < 4000; ++frame)
            {
                now += random.Next(40) == 0 ? 0.3 * random.NextDouble() : FrameSeconds * (0.7 + 0.6 * random.NextDouble());
                device.AdvanceTo(now);
                wave.IsSilent ^= random.Next(20) == 0;
                wave.IsStopped ^= random.Next(30) == 0;
                if (random.Next(60) == 0)
                {
                    device.IsThere ^= true;
                    device.Stop();
                }
                queue.Update(now);
                Assert.That(device.AmplitudeAt(now + 0.2), Is.Zero);
            }
            Assert.That(device.Streams, Is.GreaterThan(30));
        }

        [Test]
        public void FramesAllocateNothing()
        {
            var motor = new Silent();
            var queue = new ParametricQueue(motor, SimulatedWave.Sine(100.0));
            double now = 0.0;
            long before = 0L;
            for (int frame = 0; frame < 1000; ++frame, now += FrameSeconds)
            {
                before = frame == 200 ? GC.GetAllocatedBytesForCurrentThread() : before;
                queue.Update(now);
            }
            Assert.That(GC.GetAllocatedBytesForCurrentThread() - before, Is.Zero);
        }

        private sealed class Silent : IParametricSink
        {
            public string Name => "nothing";

            public bool TryGetCapabilities(out HapticSinkCapabilities capabilities)
            {
                capabilities = new HapticSinkCapabilities(0.0, 500, 50.0, 450.0);
                return true;
            }

            public bool Submit(ReadOnlySpan<ParametricPoint> amplitudes, ReadOnlySpan<ParametricPoint> frequencies,
                ReadOnlySpan<ParametricTransient> transients, StreamPart part) => true;

            public void Stop()
            {
            }
        }
    }
}
