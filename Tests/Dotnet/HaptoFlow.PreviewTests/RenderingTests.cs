using System;
using System.Collections.Concurrent;
using System.Linq;
using System.Threading;
using HaptoFlow.Model;
using HaptoFlow.Preview;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    /// <summary>Previews rendered with the real native library, ONNX Runtime and the default model.</summary>
    public sealed class RenderingTests
    {
        private static readonly Stroke Slide =
            PresetStrokes.Make(StrokePreset.Slide, new StrokeSettings(0.12, 1.0, 0.0, 0.6));

        private PreviewWorker worker = null!;

        [SetUp]
        public void Begin() => worker = new PreviewWorker();

        [TearDown]
        public void End() => worker.Dispose();

        private static PreviewRequest Request(params LabelMix[] materials) =>
            new PreviewRequest(ModelFiles.Default, Slide, materials)
            {
                Tier = "draft",
            };

        private PreviewResult Do(PreviewRequest request) => worker.Do(request, CancellationToken.None);

        private float[] Samples(PreviewRequest request) => Do(request).Sounds[0].Sound.Samples;

        [Test]
        public void AStrokeIsSilentBeforeAndAfterContact()
        {
            PreviewSound sound = Do(Request(new LabelMix("sandpaper"))).Sounds[0].Sound;
            Assert.That(sound.Samples.Length, Is.EqualTo((int)Math.Round(48000.0 * Slide.DurationSeconds)));
            Assert.That(sound.Samples, Is.All.InRange(-1f, 1f));
            Assert.That(sound.Samples.Take(4700), Is.All.Zero, "0.1 s in the air");
            Assert.That(sound.Samples.Skip((int)(48000 * 0.74)), Is.All.Zero,
                "5 ms of fade, and the filters, are over");
            int touching = sound.Samples.Skip(5000).Take(28000).Count(sample => sample != 0f);
            Assert.That(touching, Is.GreaterThan(27000));
        }

        [Test]
        public void TheRmsIsCloseToThatOfTheTiersOwnSegments()
        {
            double rms = Do(Request(new LabelMix("sandpaper"))).Sounds[0].Sound.RmsMps2;
            using OnnxRuntime runtime = OnnxRuntime.Open();
            using HapticModel model = HapticModel.Open(ModelFiles.Default);
            using var generator = new HapticGenerator(runtime, model, "draft");
            int label = model.Labels.Single(each => each.Name == "sandpaper").Index;
            float[] previous = new float[HapticGenerator.SegmentSamples];
            var random = new Random(1);
            double power = 0.0;
            const int Segments = 40;
            for (int segment = -5; segment < Segments; ++segment)
            {
                var next = new float[previous.Length];
                generator.Generate(
                    model.Embedding(label), new[] { 0.12f, 0f, 1f }, previous, TierTiming.Noise(random), next);
                power += segment < 0 ? 0.0 : next.Average(sample => (double)sample * sample) / Segments;
                previous = next;
            }
            Assert.That(10.0 * Math.Log10(rms * rms / power), Is.EqualTo(0.0).Within(2.5));
        }

        [TestCase(nameof(StrokePreset.Taps), HapticEffects.Impact)]
        [TestCase(nameof(StrokePreset.Rims), HapticEffects.Edge)]
        public void AnEffectIsRenderedOnlyIfTheSurfaceHasIt(string name, HapticEffects effect)
        {
            StrokePreset preset = Enum.Parse<StrokePreset>(name);
            Stroke stroke = PresetStrokes.Make(preset, new StrokeSettings(0.2, 1.0, 0.0, 1.0, 0.5));
            PreviewRequest With(HapticEffects effects) =>
                new PreviewRequest(ModelFiles.Default, stroke, new[] { new LabelMix("wood") })
                {
                    Tier = "draft",
                    Effects = effects,
                };
            Assert.That(Samples(With(HapticEffects.Nothing)), Is.All.Zero);
            Assert.That(Do(With(effect)).Sounds[0].Sound.PeakMps2, Is.GreaterThan(0.5));
        }

        [Test]
        public void AMotorPlaysItsOwnFrequencyWithTheLevelOfTheWaveform()
        {
            PreviewRequest request = Request(new LabelMix("sandpaper"));
            request.Device = PreviewDevice.Motor;
            PreviewResult result = Do(request);
            Assert.That(result.Sounds, Has.Count.EqualTo(2));
            PreviewSound motor = result.Sounds[1].Sound;
            Assert.That(motor.Title, Does.Contain("motor"));
            Assert.That(motor.Samples.Length, Is.EqualTo(result.Sounds[0].Sound.Samples.Length));
            float[] middle = motor.Samples.Skip(12000).Take(19200).ToArray();
            Assert.That(middle.Max(), Is.GreaterThan(0.0005f));
            int rises = Enumerable.Range(1, middle.Length - 1)
                .Count(index => middle[index - 1] <= 0f && middle[index] > 0f);
            Assert.That(rises, Is.EqualTo(64).Within(1), "160 Hz for 0.4 s");
            Assert.That(motor.Samples.Take(4700), Is.All.Zero, "0.1 s in the air");
        }

        [Test]
        public void TheSeedDeterminesTheSamples()
        {
            float[] first = Samples(Request(new LabelMix("cotton")));
            using var other = new PreviewWorker();
            float[] again = other.Do(Request(new LabelMix("cotton")), CancellationToken.None).Sounds[0].Sound.Samples;
            Assert.That(again, Is.EqualTo(first));
            PreviewResult both = Do(Request(new LabelMix("cotton"), new LabelMix("cotton")));
            Assert.That(both.Sounds.Select(each => each.Sound.Samples), Is.All.EqualTo(first), "what is compared too");
            PreviewRequest reseeded = Request(new LabelMix("cotton"));
            reseeded.Seed = 2;
            Assert.That(Samples(reseeded), Is.Not.EqualTo(first));
        }

        [Test]
        public void OtherRequestsThanSketchesGetAFreshEngine()
        {
            PreviewRequest sketch = Request(new LabelMix("wood"));
            sketch.IsSketch = true;
            Do(sketch);
            PreviewRequest next = Request(new LabelMix("rubber"));
            next.IsSketch = true;
            Do(next);
            float[] real = Samples(Request(new LabelMix("rubber")));
            using var other = new PreviewWorker();
            Assert.That(other.Do(Request(new LabelMix("rubber")), CancellationToken.None).Sounds[0].Sound.Samples,
                Is.EqualTo(real));
        }

        [Test]
        public void FeatureScaleTwoHalvesTheFrequencyOfRibsAndKeepsTheLevel()
        {
            const double ribHz = 0.15 / 0.0025;
            AnalysedSound[] sounds = Pair("corduroy", 2f, 0f);
            double quiet = sounds[0].Spectrum.Decibels(0.5 * ribHz);
            Assert.That(sounds[0].Spectrum.Decibels(ribHz), Is.GreaterThan(quiet + 6.0));
            Assert.That(sounds[1].Spectrum.Decibels(0.5 * ribHz), Is.GreaterThan(quiet + 6.0));
            double ratio = sounds[1].Sound.RmsMps2 / sounds[0].Sound.RmsMps2;
            Assert.That(20.0 * Math.Log10(ratio), Is.EqualTo(0.0).Within(2.0));
        }

        [Test]
        public void ToneTiltsTheSpectrumByItsDecibelsPerOctave()
        {
            const float tone = 6f;
            AnalysedSound[] sounds = Pair("sandpaper", 1f, tone);
            double Raised(double hertz) => ThirdOctaveDb(sounds[1], hertz) - ThirdOctaveDb(sounds[0], hertz);
            Assert.That(Raised(300.0) - Raised(75.0), Is.EqualTo(2.0 * tone).Within(1.5));
        }

        /// <summary>A label as it is, and with another feature scale and tone, at 0.15 m/s.</summary>
        private AnalysedSound[] Pair(string label, float featureScale, float toneDbPerOctave) =>
            Do(Request(new LabelMix(label), new LabelMix(label, "", 0f, "", null, featureScale, toneDbPerOctave)) with
            {
                Stroke = PresetStrokes.Make(StrokePreset.Slide, new StrokeSettings(0.15, 1.0, 0.0, 1.5)),
            }).Sounds.ToArray();

        private static double ThirdOctaveDb(AnalysedSound sound, double hertz) =>
            10.0 * Math.Log10(Enumerable.Range(-20, 41).Select(step => hertz * Math.Pow(2.0, step / 120.0))
                .Average(each => Math.Pow(10.0, 0.1 * sound.Spectrum.Decibels(each))));

        [Test]
        public void EveryTierIsTimedOncePerMeasurement()
        {
            PreviewRequest request = Request(new LabelMix("wood"));
            Assert.That(Do(request).Qualities.Select(row => row.Timing), Is.All.Null);
            request.Measurement = 1;
            QualityRow[] rows = Do(request).Qualities.ToArray();
            Assert.That(rows.Select(row => row.Name), Is.SupersetOf(new[] { "draft", "standard" }));
            foreach (QualityRow row in rows)
            {
                Assert.That(row.Timing!.MedianMs, Is.GreaterThan(0.0));
                Assert.That(row.Timing.Percentile90Ms, Is.GreaterThanOrEqualTo(row.Timing.MedianMs));
                Assert.That(row.Timing.Count, Is.EqualTo(64));
            }
            Assert.That(Do(request).Qualities[0].Timing, Is.SameAs(rows[0].Timing));
            request.Measurement = 2;
            Assert.That(Do(request).Qualities[0].Timing, Is.Not.SameAs(rows[0].Timing));
        }

        [Test]
        public void AnUnknownLabelIsReportedWithTheKnownOnes()
        {
            PreviewResult result = Do(Request(new LabelMix("granite")));
            Assert.That(result.Problem, Does.Contain("\"granite\"").And.Contain("wood, plywood"));
            Assert.That(result.Qualities, Has.Count.EqualTo(ModelHeader.Read(ModelFiles.Default).Tiers.Count),
                "the header can be read");
        }

        [Test]
        public void ACancelledRequestStops()
        {
            using var cancelled = new CancellationTokenSource();
            cancelled.Cancel();
            Assert.That(() => worker.Do(Request(new LabelMix("wood")), cancelled.Token),
                Throws.InstanceOf<OperationCanceledException>());
        }
    }

    public sealed class LatestTaskTests
    {
        [Test]
        public void OnlyTheNewestWaitingRequestIsRun()
        {
            using var gate = new SemaphoreSlim(0);
            var begun = new ConcurrentQueue<string>();
            using var task = new LatestTask<string, string>((request, _) =>
            {
                begun.Enqueue(request);
                gate.Wait(CancellationToken.None);
                return request + "!";
            });
            task.Submit("first");
            task.Submit("second");
            task.Submit("third");
            gate.Release(2);
            task.Wait();
            Assert.That(task.Poll(), Is.EqualTo("first!"));
            Assert.That(task.IsBusy, Is.True);
            task.Wait();
            Assert.That(task.Poll(), Is.EqualTo("third!"));
            Assert.That(task.IsBusy, Is.False);
            Assert.That(task.Poll(), Is.Null);
            Assert.That(begun, Is.EqualTo(new[] { "first", "third" }));
        }

        [Test]
        public void PollThrowsTheExceptionOfTheWorkAndTheNextRequestRuns()
        {
            using var task = new LatestTask<string, string>((request, _) =>
                request == "bad" ? throw new FormatException("bad request") : request);
            task.Submit("bad");
            task.Submit("good");
            task.Wait();
            Assert.That(() => task.Poll(), Throws.TypeOf<FormatException>());
            task.Wait();
            Assert.That(task.Poll(), Is.EqualTo("good"));
        }

        [Test]
        public void DisposeCancelsTheRunningRequestAndWaitsForIt()
        {
            using var begun = new ManualResetEventSlim();
            bool ended = false;
            var task = new LatestTask<string, string>((request, token) =>
            {
                begun.Set();
                token.WaitHandle.WaitOne();
                Volatile.Write(ref ended, true);
                token.ThrowIfCancellationRequested();
                return request;
            });
            task.Submit("endless");
            task.Submit("never run");
            begun.Wait();
            task.Dispose();
            Assert.That(Volatile.Read(ref ended), Is.True);
            Assert.That(task.IsBusy, Is.False);
        }
    }
}
