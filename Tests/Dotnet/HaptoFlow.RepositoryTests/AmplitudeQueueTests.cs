#nullable enable
using System;
using System.Linq;
using HaptoFlow.Outputs;
using NUnit.Framework;
using static HaptoFlow.RepositoryTests.Playback;

namespace HaptoFlow.RepositoryTests
{
    /// <summary>The commands that a simulated motor receives.</summary>
    public sealed class AmplitudeQueueTests
    {
        [Test]
        public void TheMotorIsUpdatedForAMinuteAndNeverFasterThanItAccepts([Values(45.0, 72.0, 500.0)] double rateHz)
        {
            var motor = new SimulatedMotor { RateHz = rateHz };
            var queue = new AmplitudeQueue(motor, SimulatedWave.Sine(120.0));
            double now = 0.0;
            int silent = 0;
            var random = new Random(3);
            while (now < 60.0)
            {
                now += FrameSeconds * (0.85 + 0.3 * random.NextDouble());
                silent += now > 1.0 && motor.AmplitudeAt(now) <= 0f ? 1 : 0;
                motor.AdvanceTo(now);
                queue.Update(now);
                Assert.That(queue.Statistics.LatencyMilliseconds, Is.LessThan(1000.0 * (0.0135 + 1.3 / rateHz + 2.0 * FrameSeconds)));
            }
            Assert.That(silent, Is.Zero);
            Assert.That(queue.Statistics.Gaps, Is.Zero);
            Assert.That(motor.Commands.Count, Is.LessThanOrEqualTo(60.0 * Math.Min(rateHz, 85.0) + 2.0));
            Assert.That(motor.Commands.Count, Is.GreaterThan(60.0 * Math.Min(0.9 * rateHz, 70.0)));
        }

        [Test]
        public void APlayableToneKeepsItsAmplitudeAndFrequency([Values(0.05, 0.2, 0.6)] double amplitude)
        {
            var motor = new SimulatedMotor { MinFrequencyHz = 60.0, MaxFrequencyHz = 400.0 };
            Play(motor, new AmplitudeQueue(motor, SimulatedWave.Sine(216.0, amplitude)), 0.0, 1.0);
            Assert.That(motor.Commands.Skip(8).Select(each => (double)each.Amplitude),
                Is.All.EqualTo(amplitude).Within(0.08 * amplitude));
            Assert.That(motor.Commands.Skip(8).Select(each => (double)each.Hertz), Is.All.EqualTo(216.0).Within(12.0));
        }

        [Test]
        public void AnUnknownMotorPlays160HertzOfTheSameIntensity()
        {
            var motor = new SimulatedMotor();
            var queue = new AmplitudeQueue(motor, SimulatedWave.Sine(400.0, 0.2));
            queue.FullScaleMps2 = 60f;
            Play(motor, queue, 0.0, 1.0);
            // The threshold of perception is 0.56 m/s^2 at 400 Hz and 0.03 m/s^2 at 160 Hz, so 12 m/s^2 at 400 Hz feel
            // as intense as much less at 160 Hz.
            Assert.That(motor.Commands.Skip(8).Select(each => (double)each.Amplitude), Is.All.InRange(0.002, 0.1));
            Assert.That(motor.Commands.Skip(8).Select(each => each.Hertz), Is.All.EqualTo(160f));
        }

        [Test]
        public void TheAmplitudeFollowsTheEnvelopeWithinAFrame()
        {
            // The amplitude is modulated at 3 Hz.
            static double Envelope(double seconds) => 0.4 + 0.3 * Math.Sin(2.0 * Math.PI * 3.0 * seconds);
            var motor = new SimulatedMotor { MinFrequencyHz = 60.0, MaxFrequencyHz = 400.0 };
            Play(motor, new AmplitudeQueue(motor, new SimulatedWave(seconds =>
                Envelope(seconds) * Math.Sin(2.0 * Math.PI * 216.0 * seconds))), 0.0, 3.0);
            foreach ((double seconds, float amplitude, _, _) in motor.Commands.Skip(5))
            {
                double waveSeconds = seconds - 0.5 * FrameSeconds - WaveFeatures.LatencySeconds - 0.004;
                Assert.That(amplitude, Is.EqualTo(Envelope(waveSeconds)).Within(0.1));
            }
        }

        [Test]
        public void AHitchCausesAGapAndNoStuckVibration()
        {
            var motor = new SimulatedMotor();
            var queue = new AmplitudeQueue(motor, SimulatedWave.Sine(160.0));
            double now = Play(motor, queue, 0.0, 1.0);
            Assert.That(motor.AmplitudeAt(now + AmplitudeQueue.MaximumSeconds), Is.Zero);
            Play(motor, queue, now + 0.2, 0.5);
            Assert.That(queue.Statistics.Gaps, Is.EqualTo(1));
            Assert.That(motor.Commands.Last().Amplitude, Is.EqualTo(0.3f).Within(0.05f));
        }

        [Test]
        public void AStopReachesTheMotorInTheSameFrame()
        {
            var motor = new SimulatedMotor();
            SimulatedWave wave = SimulatedWave.Sine(120.0);
            var queue = new AmplitudeQueue(motor, wave);
            double now = Play(motor, queue, 0.0, 1.0);
            wave.IsStopped = true;
            now = Play(motor, queue, now, 0.5 * FrameSeconds);
            AssertStopsWithoutFurtherCommands(motor, queue, now);
        }

        [Test]
        public void SilenceReachesTheMotorAfterTheFeatureFilter()
        {
            var motor = new SimulatedMotor();
            SimulatedWave wave = SimulatedWave.Sine(120.0);
            var queue = new AmplitudeQueue(motor, wave);
            double now = Play(motor, queue, 0.0, 1.0);
            float before = motor.AmplitudeAt(now);
            wave.IsSilent = true;
            now = Play(motor, queue, now, 2.5 * FrameSeconds);
            Assert.That(motor.AmplitudeAt(now), Is.LessThan(0.06f * before), "-24 dB after 35 ms");
            now = Play(motor, queue, now, 4.0 * FrameSeconds);
            AssertStopsWithoutFurtherCommands(motor, queue, now);
        }

        /// <summary>The motor is off, and receives no repeated stop commands.</summary>
        private static void AssertStopsWithoutFurtherCommands(SimulatedMotor motor, AmplitudeQueue queue, double now)
        {
            int commandCount = motor.Commands.Count;
            Assert.That(motor.AmplitudeAt(now), Is.Zero);
            Play(motor, queue, now, 1.0);
            Assert.That(motor.Commands.Count, Is.EqualTo(commandCount));
        }

        [Test]
        public void RandomStrokesHitchesStopsAndLossesLeaveNoStuckVibration([Range(1, 4)] int seed)
        {
            var random = new Random(seed);
            var motor = new SimulatedMotor();
            SimulatedWave wave = SimulatedWave.Sine(90.0, 0.9);
            var queue = new AmplitudeQueue(motor, wave);
            queue.Gain = 5f;
            queue.Ceiling = 0.7f;
            double now = 0.0;
            for (int frame = 0; frame < 4000; ++frame)
            {
                now += random.Next(40) == 0 ? 0.3 * random.NextDouble() : FrameSeconds * (0.7 + 0.6 * random.NextDouble());
                motor.AdvanceTo(now);
                wave.IsSilent ^= random.Next(20) == 0;
                wave.IsStopped ^= random.Next(30) == 0;
                motor.IsThere ^= random.Next(60) == 0;
                motor.RateHz = random.Next(100) == 0 ? 40.0 + 200.0 * random.NextDouble() : motor.RateHz;
                queue.Update(now);
                Assert.That(motor.AmplitudeAt(now + AmplitudeQueue.MaximumSeconds), Is.Zero);
                if (wave.IsStopped && motor.IsThere)
                {
                    Assert.That(motor.AmplitudeAt(now), Is.Zero);
                }
            }
            Assert.That(motor.Commands.Max(each => each.Amplitude), Is.LessThanOrEqualTo(0.7f));
        }
    }
}
