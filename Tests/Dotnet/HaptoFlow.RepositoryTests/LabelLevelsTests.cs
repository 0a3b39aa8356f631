#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using HaptoFlow.Native;
using HaptoFlow.Outputs;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

namespace HaptoFlow.RepositoryTests
{
    /// <summary>How strongly each kind of device plays every label of the shipped model at an ordinary stroke, through
    /// the queues that a scene uses.</summary>
    public sealed class LabelLevelsTests : OpenModelTest
    {
        private const double TipRadiusMetres = 0.002;
        private const double StiffnessNewtonsPerMetre = 1000.0;
        private const float FullScaleMps2 = (float)HapticEngineOptions.DefaultFullScaleMps2;

        // The peaks of a waveform depend on how long one waits for them: the same time at every frame rate.
        private const double PeakSeconds = 1.0 / 72.0;

        private static readonly Dictionary<(string Label, double Hertz), float[]> Waves =
            new Dictionary<(string, double), float[]>();

        // Compiled ahead of time, NUnit cannot list the values of an enumeration.
        private static readonly HapticForm[] Forms =
            { HapticForm.Amplitude, HapticForm.Parametric, HapticForm.Waveform };

        [Test]
        public void EveryLabelIsFeltTheMiddleOneWellAndTheStrongestFitsAtAnyFrameRate(
            [ValueSource(nameof(Forms))] HapticForm form, [Values(72.0, 120.0)] double frameHz)
        {
            (string Label, double Median, double Ninetieth)[] levels = model.Labels.Select(label =>
            {
                double[] played = Play(form, WaveOf(label.Name, frameHz), frameHz, 1f);
                return (label.Name, Median(played), Percentile(played, 0.9));
            }).ToArray();
            double[] medians = levels.Select(each => each.Median).OrderBy(each => each).ToArray();
            string all = string.Join(", ", levels.Select(each => $"{each.Label} {each.Median:0.000}/{each.Ninetieth:0.00}"));
            TestContext.Out.WriteLine(all);
            Assert.That(levels, Has.Length.EqualTo(20));
            Assert.That(medians[0], Is.GreaterThanOrEqualTo(0.08), all);
            Assert.That(0.5 * (medians[9] + medians[10]), Is.EqualTo(0.35).Within(0.04), all);
            Assert.That(levels.Max(each => each.Ninetieth), Is.LessThan(1.0), all);
            Assert.That(levels.Max(each => each.Ninetieth), Is.GreaterThan(0.7), all);
        }

        [Test]
        public void DeviceLoudnessScalesWhatIsSentAndZeroIsSilent([ValueSource(nameof(Forms))] HapticForm form)
        {
            float[] wave = WaveOf(model.Labels.First().Name, 72.0);
            double whole = Median(Play(form, wave, 72.0, gain: 1f));
            Assert.That(Median(Play(form, wave, 72.0, gain: 0.5f)), Is.EqualTo(0.5 * whole).Within(0.03 * whole));
            Assert.That(Play(form, wave, 72.0, gain: 0f), Is.Empty);
        }

        private float[] WaveOf(string label, double frameHz)
        {
            if (!Waves.TryGetValue((label, frameHz), out float[]? wave))
            {
                wave = Render(model.Labels.ToList().FindIndex(each => each.Name == label), frameHz);
                Waves.Add((label, frameHz), wave);
            }
            return wave;
        }

        private float[] Render(int label, double frameHz)
        {
            double[][] stroke = File.ReadLines(RepositoryFiles.In("Samples~", "HeadlessScenes", "tracing.stroke.csv"))
                .Skip(1).Select(line => line.Split(',').Select(each => double.Parse(each, CultureInfo.InvariantCulture)).ToArray())
                .ToArray();
            using var engine = new HapticEngine(runtime, model,
                new HapticEngineOptions
                {
                    Quality = HapticQuality.Standard, WithoutWorker = true, FixedLeadMs = 8.0, Seed = 5, UpdateRateHz = frameHz,
                });
            using HapticVoice voice = engine.OpenVoice(WaveHistory.RateHz);
            var wave = new float[(int)(stroke[^1][0] * WaveHistory.RateHz)];
            uint touches = 0;
            bool wasTouching = false;
            int written = 0;
            for (double now = 1.0 / frameHz; now < stroke[^1][0]; now += 1.0 / frameHz)
            {
                double[] tip = At(stroke, now);
                double[] before = At(stroke, now - 1.0 / frameHz);
                double depth = TipRadiusMetres - tip[1];
                bool isTouching = depth > 0.0;
                touches += isTouching && !wasTouching ? 1u : 0u;
                wasTouching = isTouching;
                voice.Publish(new ContactState
                {
                    Touching = isTouching,
                    TouchCounter = touches,
                    Material = LabelBlend.Of(label),
                    FirstVelocityMps = (float)((tip[0] - before[0]) * frameHz),
                    SecondVelocityMps = (float)((tip[2] - before[2]) * frameHz),
                    ForceNewtons = (float)(StiffnessNewtonsPerMetre * Math.Max(0.0, depth)),
                });
                engine.Step();
                int end = Math.Min(wave.Length, (int)(now * WaveHistory.RateHz));
                voice.Render(wave.AsSpan(written, end - written), 1, 0, WaveHistory.RateHz);
                written = end;
            }
            return wave;
        }

        /// <summary>x, y, z at a time.</summary>
        private static double[] At(double[][] stroke, double seconds)
        {
            int after = Math.Max(1, Array.FindIndex(stroke, row => row[0] >= seconds));
            double share = (seconds - stroke[after - 1][0]) / (stroke[after][0] - stroke[after - 1][0]);
            return Enumerable.Range(1, 3)
                .Select(axis => stroke[after - 1][axis] + share * (stroke[after][axis] - stroke[after - 1][axis])).ToArray();
        }

        /// <summary>The amplitudes that the device gets, or plays in each frame of the display; without silence.</summary>
        private static double[] Play(HapticForm form, float[] wave, double frameHz, float gain)
        {
            var motor = new SimulatedMotor();
            var parametric = new SimulatedParametricDevice { RangeHz = (60.0, 400.0) };
            var device = new SimulatedWaveDevice(2000.0);
            var source = new SimulatedWave(
                seconds => wave.ElementAtOrDefault((int)Math.Round(seconds * WaveHistory.RateHz)));
            using HapticQueue queue = form switch
            {
                HapticForm.Amplitude => new AmplitudeQueue(motor, source),
                HapticForm.Parametric => new ParametricQueue(parametric, source),
                _ => new WaveformQueue(device, source),
            };
            queue.TrueLevel = false;
            queue.Gain = gain;
            queue.FullScaleMps2 = FullScaleMps2;
            for (double now = 1.0 / frameHz; now < wave.Length / WaveHistory.RateHz; now += 1.0 / frameHz)
            {
                motor.AdvanceTo(now);
                parametric.AdvanceTo(now);
                device.AdvanceTo(now);
                queue.Update(now);
            }
            IEnumerable<double> found = form switch
            {
                HapticForm.Amplitude => motor.Commands.Select(each => (double)each.Amplitude),
                HapticForm.Parametric => parametric.Amplitudes,
                _ => device.Played.GroupBy(each => (int)(each.Seconds / PeakSeconds))
                    .Select(frame => frame.Max(each => (double)Math.Abs(each.Sample))),
            };
            return found.Where(each => each > 1e-4).ToArray();
        }

        private static double Median(double[] values) => Percentile(values, 0.5);

        private static double Percentile(double[] values, double share)
        {
            double[] sorted = values.OrderBy(each => each).ToArray();
            return sorted[(int)(share * (sorted.Length - 1))];
        }
    }
}
