#nullable enable
using System;
using HaptoFlow.Outputs;
using NUnit.Framework;

namespace HaptoFlow.RepositoryTests
{
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
