using System;
using System.Linq;
using System.Threading;
using HaptoFlow.Model;
using HaptoFlow.Preview;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    /// <summary>Feature scale and tone in the preview, with the real native library.</summary>
    public sealed class ScaleAndToneTests
    {
        // Corduroy's ribs are 2.5 mm apart.
        private const double RibHz = SpeedMps / 0.0025;
        private const double SpeedMps = 0.15;

        private static readonly Stroke Slide =
            PresetStrokes.Make(StrokePreset.Slide, new StrokeSettings(SpeedMps, 1.0, 0.0, 1.5));

        private PreviewWorker worker = null!;

        [SetUp]
        public void Begin() => worker = new PreviewWorker();

        [TearDown]
        public void End() => worker.Dispose();

        private static LabelMix Mix(string label, float featureScale = 1f, float toneDbPerOctave = 0f) =>
            new LabelMix(label, "", 0f, "", null, featureScale, toneDbPerOctave);

        private PreviewSound[] Render(params LabelMix[] materials)
        {
            PreviewResult result = worker.Do(new PreviewRequest(ModelFiles.Default, Slide, materials)
            {
                Tier = "draft",
            }, CancellationToken.None);
            Assert.That(result.Problem, Is.Null);
            return result.Sounds.Select(each => each.Sound).ToArray();
        }

        [Test]
        public void FeatureScaleTwoHalvesTheFrequencyOfRibsAndKeepsTheLevel()
        {
            PreviewSound[] sounds = Render(Mix("corduroy"), Mix("corduroy", 2f));
            double[] plain = { PowerAt(sounds[0], RibHz), PowerAt(sounds[0], 0.5 * RibHz) };
            double[] large = { PowerAt(sounds[1], RibHz), PowerAt(sounds[1], 0.5 * RibHz) };
            Assert.That(plain[0], Is.GreaterThan(4.0 * plain[1]));
            Assert.That(large[1], Is.GreaterThan(4.0 * plain[1]));
            Assert.That(20.0 * Math.Log10(sounds[1].RmsMps2 / sounds[0].RmsMps2), Is.EqualTo(0.0).Within(2.0));
        }

        [TestCase(6f)]
        public void ToneTiltsTheSpectrumByItsDecibelsPerOctave(float tone)
        {
            PreviewSound[] sounds = Render(Mix("sandpaper"), Mix("sandpaper", 1f, tone));
            double Raised(double hertz) =>
                10.0 * Math.Log10(BandPower(sounds[1], hertz) / BandPower(sounds[0], hertz));
            Assert.That(Raised(300.0) - Raised(75.0), Is.EqualTo(2.0 * tone).Within(1.5));
        }

        [Test]
        public void ASoundIsNotReusedForAnotherFeatureScaleOrTone()
        {
            float[] plain = Render(Mix("corduroy"))[0].Samples;
            float[] large = Render(Mix("corduroy", 2f))[0].Samples;
            float[] bright = Render(Mix("corduroy", 2f, 3f))[0].Samples;
            Assert.That(large.SequenceEqual(plain), Is.False);
            Assert.That(bright.SequenceEqual(large), Is.False);
            Assert.That(Render(Mix("corduroy"))[0].Samples.SequenceEqual(plain), Is.True);
        }

        [TestCase(1f, 0f, "corduroy")]
        [TestCase(2f, 0f, "corduroy (x2)")]
        [TestCase(0.25f, 0f, "corduroy (x0.25)")]
        [TestCase(1f, -4.5f, "corduroy (-4.5 dB/oct)")]
        [TestCase(2f, 3f, "corduroy (x2, +3 dB/oct)")]
        public void TheTitleNamesFeatureScaleAndToneUnlessTheyAreDefaults(float scale, float tone, string title) =>
            Assert.That(Mix("corduroy", scale, tone).Title, Is.EqualTo(title));

        /// <summary>Mean power in a third of an octave.</summary>
        private static double BandPower(PreviewSound sound, double hertz)
        {
            double sum = 0.0;
            for (int step = -20; step <= 20; ++step)
            {
                sum += PowerAt(sound, hertz * Math.Pow(2.0, step / 120.0));
            }
            return sum;
        }

        /// <summary>Spectrum of one second in the middle of the stroke.</summary>
        private static double PowerAt(PreviewSound sound, double hertz)
        {
            const int count = PreviewSound.RateHz;
            int begin = (sound.Samples.Length - count) / 2;
            double real = 0.0;
            double imaginary = 0.0;
            for (int index = 0; index < count; ++index)
            {
                double window = 0.5 - 0.5 * Math.Cos(2.0 * Math.PI * index / count);
                double phase = 2.0 * Math.PI * hertz * index / PreviewSound.RateHz;
                real += window * sound.Samples[begin + index] * Math.Cos(phase);
                imaginary += window * sound.Samples[begin + index] * Math.Sin(phase);
            }
            return real * real + imaginary * imaginary;
        }
    }
}
