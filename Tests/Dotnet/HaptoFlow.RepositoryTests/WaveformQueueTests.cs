#nullable enable
using System;
using System.Linq;
using HaptoFlow.Outputs;
using NUnit.Framework;
using static HaptoFlow.RepositoryTests.Playback;

namespace HaptoFlow.RepositoryTests
{
    /// <summary>The samples that reach a simulated device with its own clock.</summary>
    public sealed class WaveformQueueTests
    {
        // At 45 Hz the filter reads 1.5 samples of the device ahead, and a sample lasts 22 ms.
        private static double MaximumLatencyMs(double rateHz) => 1000.0 * (FramePace.MaximumDepthSeconds +
            2.0 / rateHz + Math.Max(0.012, 1.6 / rateHz));

        [Test]
        public void TheQueueNeitherStarvesNorGrowsInAMinuteAtAnyRateAndDrift(
            [Values(45.0, 320.0, 2000.0)] double rateHz, [Values(-0.005, 0.0, 0.005)] double drift,
            [Values] bool replaces)
        {
            var device = new SimulatedWaveDevice(rateHz, drift, replaces) { Records = false };
            var queue = new WaveformQueue(device, new SimulatedWave(seconds => 0.3 - 0.6 * (15.0 * seconds % 1.0)));
            var random = new Random(7);
            double now = 0.0;
            double deepest = 0.0;
            double longestLatency = 0.0;
            for (int frame = 0; now < 60.0; ++frame)
            {
                now += FrameSeconds * (0.85 + 0.3 * random.NextDouble());
                device.AdvanceTo(now);
                if (frame == 20)
                {
                    device.ForgetStarvation();
                }
                queue.Update(now);
                deepest = Math.Max(deepest, device.DepthSeconds);
                longestLatency = Math.Max(longestLatency, queue.Statistics.LatencyMilliseconds);
            }
            Assert.That(device.Starved, Is.Zero);
            Assert.That(queue.Statistics.Gaps, Is.Zero);
            Assert.That(deepest, Is.LessThan(0.030 + 2.0 / rateHz));
            Assert.That(longestLatency, Is.InRange(1000.0 * FrameSeconds, MaximumLatencyMs(rateHz)));
        }

        [Test]
        public void AHitchCausesAGapWithAFadeAtBothEnds([Values(0.003, 0.2, 1.0)] double hitchSeconds,
            [Values(0, 3, 5)] int moment)
        {
            var device = new SimulatedWaveDevice(2000.0);
            var queue = new WaveformQueue(device, SimulatedWave.Sine(50.0, 0.5));
            double now = Play(device, queue, 0.0, 0.5 + 0.0017 * moment);
            double begins = now;
            now += hitchSeconds;
            device.AdvanceTo(now);
            queue.Update(now);
            Play(device, queue, now, 0.3);
            // The largest step of a sine of 50 Hz at 2 kHz, plus that of a fade over 2 ms.
            double steepest = 0.5 * 2.0 * Math.PI * 50.0 / 2000.0 + 0.5 / 4.0;
            float[] played = Between(device, 0.1, now + 0.3);
            int worst = Enumerable.Range(1, played.Length - 1)
                .OrderByDescending(index => Math.Abs(played[index] - played[index - 1])).First();
            Assert.That(Math.Abs(played[worst] - played[worst - 1]), Is.LessThan(steepest),
                $"at {0.1 + worst / 2000.0} s, hitch from {begins} s to {now} s: {string.Join(" ", played.Skip(worst - 8).Take(16))}");
            if (hitchSeconds >= 0.2)
            {
                float[] gap = Between(device, begins + 0.03, begins + hitchSeconds);
                Assert.That(gap, Is.All.Zero);
                Assert.That(queue.Statistics.Gaps, Is.EqualTo(1));
            }
            float[] after = Between(device, now + 0.05, now + 0.25);
            Assert.That(Rms(after), Is.EqualTo(0.5 / Math.Sqrt(2.0)).Within(0.02));
        }

        [Test]
        public void AHitchOfAQueueingDeviceEndsAtASmallSampleAndFadesIn(
            [Values(0, 3, 5)] int moment)
        {
            var device = new SimulatedWaveDevice(2000.0, 0.0, false);
            var queue = new WaveformQueue(device, SimulatedWave.Sine(200.0, 0.5));
            double now = Play(device, queue, 0.0, 0.5 + 0.0017 * moment);
            double begins = now;
            now += 0.2;
            device.AdvanceTo(now);
            queue.Update(now);
            Play(device, queue, now, 0.3);
            float[] gap = Between(device, begins, now);
            int last = Array.FindLastIndex(gap, sample => sample != 0f);
            Assert.That(last, Is.LessThan(0.03 * 2000.0));
            Assert.That(Math.Abs(gap[last]), Is.LessThan(0.17), "for an amplitude of 0.5");
            Assert.That(Math.Abs(Between(device, now - 0.0001, now + 0.0006).Last()), Is.LessThan(0.15));
        }

        [Test]
        public void AStopReachesTheDeviceInTheSameFrame([Values] bool replaces)
        {
            var device = new SimulatedWaveDevice(2000.0, 0.0, replaces);
            SimulatedWave wave = SimulatedWave.Sine(100.0);
            var queue = new WaveformQueue(device, wave);
            double now = Play(device, queue, 0.0, 0.5);
            wave.IsStopped = true;
            queue.Update(now);
            Assert.That(queue.IsPlaying, Is.False);
            Play(device, queue, now, 0.5);
            Assert.That(Between(device, now + WaveformQueue.FadeSeconds + 0.001, now + 0.5), Is.All.Zero);
            Assert.That(queue.Statistics.Stops, Is.EqualTo(1));
            wave.IsStopped = false;
            now = Play(device, queue, now + 0.5, 0.2);
            Assert.That(Rms(Between(device, now - 0.1, now)), Is.GreaterThan(0.15), "it plays again");
        }

        [Test]
        public void ASilentWaveKeepsTheDeviceIdle([Values] bool replaces)
        {
            var device = new SimulatedWaveDevice(2000.0, 0.0, replaces);
            SimulatedWave wave = SimulatedWave.Sine(100.0);
            wave.IsSilent = true;
            var queue = new WaveformQueue(device, wave);
            double now = Play(device, queue, 0.0, 1.0);
            Assert.That(device.Submissions, Is.Zero);
            wave.IsSilent = false;
            now = Play(device, queue, now, 0.2);
            Assert.That(device.Submissions, Is.GreaterThan(10));
            wave.IsSilent = true;
            now = Play(device, queue, now, 0.1);
            int before = device.Submissions;
            Play(device, queue, now, 1.0);
            Assert.That(device.Submissions, Is.EqualTo(before));
            Assert.That(Between(device, now, now + 1.0), Is.All.Zero);
        }

        [Test]
        public void ThePlayedSamplesHaveTheSpectrumOfTheWave([Values(90.0, 200.0, 400.0)] double hertz,
            [Values(-0.005, 0.0, 0.005)] double drift, [Values] bool replaces)
        {
            var device = new SimulatedWaveDevice(2000.0, drift, replaces);
            Play(device, new WaveformQueue(device, SimulatedWave.Sine(hertz)), 0.0, 4.0);
            // When submissions queue, aligning the device with the clock causes a phase jump about twice a second.
            double elsewhereDb = ElsewhereDb(device, hertz, 1.0, 3.5);
            TestContext.WriteLine($"{hertz} Hz, drift {drift}, replaces {replaces}: {elsewhereDb:0.0} dB elsewhere");
            Assert.That(elsewhereDb, Is.LessThan(drift == 0.0 && !replaces ? -40.0 : replaces ? -20.0 : -14.0));
        }

        [Test]
        public void TheWaveIsPlayedAfterTheReportedDelay([Values(320.0, 1000.0, 2000.0)] double rateHz,
            [Values] bool replaces)
        {
            // The level changes after 1 s of the wave.
            var wave = new SimulatedWave(seconds =>
                (seconds < 1.0 ? 0.05 : 0.5) * Math.Sin(2.0 * Math.PI * 70.0 * seconds));
            var device = new SimulatedWaveDevice(rateHz, 0.0, replaces);
            var queue = new WaveformQueue(device, wave);
            double now = 0.0;
            double rendered = double.NaN;
            for (; now < 1.5; now += FrameSeconds)
            {
                device.AdvanceTo(now);
                queue.Update(now);
                rendered = double.IsNaN(rendered) && wave.Position >= WaveHistory.RateHz ? now : rendered;
            }
            double felt = device.Played.First(each => Math.Abs(each.Sample) > 0.2).Seconds;
            double reported = 0.001 * queue.Statistics.LatencyMilliseconds;
            Assert.That(felt - rendered, Is.InRange(0.0, reported + 0.25 / 70.0));
            Assert.That(felt - rendered, Is.GreaterThan(reported - FrameSeconds - 0.001));
        }

        [Test]
        public void ADisconnectedDevicePlaysAgainWhenItReturns([Values] bool replaces)
        {
            var device = new SimulatedWaveDevice(2000.0, 0.0, replaces);
            SimulatedWave wave = SimulatedWave.Sine(60.0);
            var queue = new WaveformQueue(device, wave);
            double now = Play(device, queue, 0.0, 0.5);
            device.IsThere = false;
            now = Play(device, queue, now, 0.5);
            long slept = wave.Position;
            now = Play(device, queue, now, 1.0);
            Assert.That(wave.Position, Is.EqualTo(slept), "without a device the clock of the wave stops");
            Assert.That(queue.Statistics.RateHz, Is.Zero);
            device.IsThere = true;
            device.RateHz = 320.0;
            now = Play(device, queue, now, 0.5);
            Assert.That(queue.Statistics.RateHz, Is.EqualTo(320.0));
            Assert.That(Rms(Between(device, now - 0.3, now)), Is.EqualTo(0.3 / Math.Sqrt(2.0)).Within(0.03));
            device.RateHz = 2000.0;
            now = Play(device, queue, now, 0.5);
            Assert.That(Rms(Between(device, now - 0.3, now)), Is.EqualTo(0.3 / Math.Sqrt(2.0)).Within(0.03));
        }

        [Test]
        public void RandomStrokesHitchesStopsAndLossesLeaveNoStuckVibration([Values] bool replaces,
            [Range(1, 4)] int seed)
        {
            var random = new Random(seed);
            double[] rates = { 45.0, 320.0, 1000.0, 2000.0 };
            var device = new SimulatedWaveDevice(2000.0, 0.01 * (random.NextDouble() - 0.5), replaces);
            SimulatedWave wave = SimulatedWave.Sine(90.0, 0.9);
            var queue = new WaveformQueue(device, wave) { Gain = 3f, Ceiling = 0.8f };
            double now = 0.0;
            for (int frame = 0; frame < 4000; ++frame)
            {
                now += random.Next(40) == 0 ? 0.3 * random.NextDouble() : FrameSeconds * (0.7 + 0.6 * random.NextDouble());
                device.AdvanceTo(now);
                wave.IsSilent ^= random.Next(20) == 0;
                wave.IsStopped ^= random.Next(30) == 0;
                device.IsThere ^= random.Next(60) == 0;
                if (random.Next(100) == 0)
                {
                    device.RateHz = rates[random.Next(rates.Length)];
                }
                queue.Update(now);
                Assert.That(device.DepthSeconds, Is.LessThan(FramePace.MaximumDepthSeconds + 0.004 + 2.0 / device.RateHz));
            }
            wave.IsSilent = true;
            device.IsThere = true;
            now = Play(device, queue, now, 0.3);
            Play(device, queue, now, 0.2);
            Assert.That(Between(device, now, now + 0.2), Is.All.Zero);
            Assert.That(device.Played.Max(each => Math.Abs(each.Sample)), Is.LessThanOrEqualTo(0.8f));
            Assert.That(device.Played.All(each => float.IsFinite(each.Sample)));
        }

        [Test]
        public void SamplesThatAreNotNumbersNeverReachTheDevice()
        {
            var device = new SimulatedWaveDevice(2000.0);
            var queue = new WaveformQueue(device, new SimulatedWave(seconds =>
                seconds % 0.1 < 0.02 ? double.NaN : seconds % 0.1 < 0.04 ? double.PositiveInfinity : 0.2));
            Play(device, queue, 0.0, 1.0);
            Assert.That(device.Played.All(each => Math.Abs(each.Sample) <= 1f));
        }

        [Test]
        public void FramesAllocateNothing([Values] bool replaces)
        {
            var device = new SimulatedWaveDevice(2000.0, 0.005, replaces) { Records = false };
            var queue = new WaveformQueue(device, SimulatedWave.Sine(100.0));
            double now = Play(device, queue, 0.0, 2.0);
            long before = GC.GetAllocatedBytesForCurrentThread();
            Play(device, queue, now, 10.0);
            Assert.That(GC.GetAllocatedBytesForCurrentThread() - before, Is.Zero);
        }

        [Test]
        public void ADeviceThatAcceptsPartOfASubmissionGetsTheRestLater()
        {
            var device = new SimulatedWaveDevice(2000.0, 0.0, false) { Capacity = 30 };
            var queue = new WaveformQueue(device, SimulatedWave.Sine(80.0));
            double now = Play(device, queue, 0.0, 2.0);
            Assert.That(Rms(Between(device, 0.5, now)), Is.EqualTo(0.3 / Math.Sqrt(2.0)).Within(0.03));
        }

        /// <summary>The energy more than 15 Hz from a frequency, in dB of the total energy, with Hann windows of 0.25
        /// s.</summary>
        private static double ElsewhereDb(SimulatedWaveDevice device, double hertz, double from, double to)
        {
            double near = 0.0;
            double all = 0.0;
            for (double begin = from; begin + 0.25 <= to; begin += 0.125)
            {
                (double Seconds, float Sample)[] window = device.Played
                    .Where(each => each.Seconds >= begin && each.Seconds < begin + 0.25).ToArray();
                for (double bin = 4.0; bin < 980.0; bin += 4.0)
                {
                    double cosine = 0.0;
                    double sine = 0.0;
                    foreach ((double seconds, float sample) in window)
                    {
                        double weighted = sample * (0.5 - 0.5 * Math.Cos(2.0 * Math.PI * (seconds - begin) / 0.25));
                        cosine += weighted * Math.Cos(2.0 * Math.PI * bin * seconds);
                        sine += weighted * Math.Sin(2.0 * Math.PI * bin * seconds);
                    }
                    double power = cosine * cosine + sine * sine;
                    all += power;
                    near += Math.Abs(bin - hertz) <= 15.0 ? power : 0.0;
                }
            }
            return 10.0 * Math.Log10(Math.Max(1e-12, (all - near) / all));
        }

        private static float[] Between(SimulatedWaveDevice device, double from, double to) => device.Played
            .Where(each => each.Seconds >= from && each.Seconds < to).Select(each => each.Sample).ToArray();

        private static double Rms(float[] samples) => Math.Sqrt(samples.Average(sample => (double)sample * sample));
    }

    /// <summary>The spectrum of a wave after decimation to a device's rate.</summary>
    public sealed class WaveDecimatorTests
    {
        [Test]
        public void PlayableFrequenciesKeepTheirLevel(
            [Values(1000.0, 2000.0, 8000.0, 24000.0)] double rateHz, [Values(0.02, 0.1, 0.25, 0.39)] double share)
        {
            double hertz = share * Math.Min(rateHz, WaveHistory.RateHz);
            Assert.That(LevelDb(rateHz, hertz), Is.EqualTo(0.0).Within(0.1));
        }

        [Test]
        public void AliasingFrequenciesAreSuppressed(
            [Values(1000.0, 2000.0)] double rateHz, [Values(0.61, 0.75, 1.0, 1.4)] double share) =>
            Assert.That(LevelDb(rateHz, share * rateHz), Is.LessThan(-50.0));

        [Test]
        public void ALowRateWidensTheTransitionBandWithoutMoreDelay([Values(45.0, 150.0, 320.0)] double rateHz)
        {
            Assert.That(new WaveDecimator(rateHz).DelaySeconds, Is.LessThanOrEqualTo(Math.Max(0.0121, 1.6 / rateHz)));
            Assert.That(LevelDb(rateHz, 0.05 * rateHz), Is.EqualTo(0.0).Within(0.6));
            Assert.That(LevelDb(rateHz, 1.5 * rateHz), Is.LessThan(-20.0));
        }

        private static double LevelDb(double rateHz, double hertz) => 10.0 * Math.Log10(
            Energy(rateHz, seconds => Math.Sin(2.0 * Math.PI * hertz * seconds)) +
            Energy(rateHz, seconds => Math.Cos(2.0 * Math.PI * hertz * seconds)));

        private static double Energy(double rateHz, Func<double, double> sound)
        {
            var wave = new WaveHistory();
            wave.RenderTo(4000L, new SimulatedWave(sound));
            var decimator = new WaveDecimator(rateHz);
            double energy = 0.0;
            int count = 0;
            // The step is not a multiple of any period, so that every phase of the filter is used.
            for (double position = 1400.0; position < 2600.0; position += 3.0307)
            {
                double sample = decimator.SampleAt(wave, position);
                energy += sample * sample;
                ++count;
            }
            return energy / count;
        }
    }

    public sealed class RetryDelayTests
    {
        [Test]
        public void EachFailureDoublesTheDelayUpToTheLimit()
        {
            var retry = new RetryDelay(0.1, 0.5);
            double now = 10.0;
            foreach (double delay in new[] { 0.1, 0.2, 0.4, 0.5, 0.5 })
            {
                Assert.That(retry.IsDue(now));
                retry.Fail(now);
                Assert.That(retry.IsDue(now + delay - 1e-6), Is.False);
                now += delay + 1e-6;
            }
        }

        [Test]
        public void ASuccessStartsOver()
        {
            var retry = new RetryDelay(0.1, 10.0);
            retry.Fail(1.0);
            retry.Fail(2.0);
            retry.Forget();
            Assert.That(retry.IsDue(2.0));
            retry.Fail(2.0);
            Assert.That(retry.IsDue(2.1001));
        }
    }
}
