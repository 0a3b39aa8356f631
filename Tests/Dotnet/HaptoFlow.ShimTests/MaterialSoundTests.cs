using System;
using System.IO;
using System.Linq;
using HaptoFlow.Tests;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.ShimTests
{
    public sealed class FeatureScaleTests : SceneTest
    {
        // The ribs of corduroy are 2.5 mm apart.
        private const double RibMetres = 0.0025;
        private const double SpeedMps = 0.15;
        private const double Seconds = 1.5;

        [Test]
        public void DoublingTheFeatureScaleHalvesTheFrequencyOfRibs()
        {
            double ribHz = SpeedMps / RibMetres;
            Func<double, double> plain = Stroke(material => material.Label = "corduroy");
            Assert.That(Band(plain, ribHz), Is.GreaterThan(2.0 * Band(plain, 0.5 * ribHz)));
            EndScene();
            BeginScene();
            Func<double, double> large = Stroke(material =>
            {
                material.Label = "corduroy";
                material.FeatureScale = 2f;
            });
            Assert.That(Band(large, 0.5 * ribHz), Is.GreaterThan(2.0 * Band(large, ribHz)));
        }

        [Test]
        public void ABrightToneRaisesHighFrequenciesAndNoToneRunsNothing()
        {
            Func<double, double> plain = Stroke(material => material.Label = "sandpaper");
            Assert.That(ToneRuns, Is.Zero, "no tone is set");
            EndScene();
            BeginScene();
            Func<double, double> bright = Stroke(material =>
            {
                material.Label = "sandpaper";
                material.ToneDbPerOctave = 6f;
            });
            Assert.That(ToneRuns, Is.GreaterThan(0UL));
            Assert.That(Band(bright, 500.0) / Band(bright, 60.0),
                Is.GreaterThan(8.0 * Band(plain, 500.0) / Band(plain, 60.0)));
        }

        private ulong ToneRuns { get; set; }

        /// <summary>The power about a frequency. The scene runs faster than the engine's clock, which therefore misjudges the
        /// time since a contact and shifts the phase of ribs from state to state: their line is broad.</summary>
        private static double Band(Func<double, double> powerAt, double hertz)
        {
            double sum = 0.0;
            for (int step = -10; step <= 10; ++step)
            {
                sum += powerAt(hertz * (1.0 + 0.02 * step));
            }
            return sum;
        }

        /// <summary>Strokes a wide board across its grain at a constant speed.</summary>
        /// <returns>The power of the output at a frequency in hertz.</returns>
        private Func<double, double> Stroke(Action<MaterialDescription> describe)
        {
            FinishLoading();
            describe(Board("wood", 2f).Material);
            Output(out _);
            HapticStylus stylus = StylusAlong(seconds => new Vector3((float)(SpeedMps * seconds - 0.5), 0.001f, 0f));
            World.Frames((int)(0.5 * World.FrameRateHz));
            AudioDevice.Forget();
            World.Frames((int)(Seconds * World.FrameRateHz));
            ToneRuns = StatisticsOf(stylus, HapticEffect.Tone).Runs;
            float[] samples = AudioDevice.Samples();
            return hertz => PowerAt(samples, hertz);
        }

        private static double PowerAt(float[] samples, double hertz)
        {
            double real = 0.0;
            double imaginary = 0.0;
            for (int index = 0; index < samples.Length; ++index)
            {
                double window = 0.5 - 0.5 * Math.Cos(2.0 * Math.PI * index / samples.Length);
                double phase = 2.0 * Math.PI * hertz * index / 48000.0;
                real += window * samples[index] * Math.Cos(phase);
                imaginary += window * samples[index] * Math.Sin(phase);
            }
            return real * real + imaginary * imaginary;
        }
    }

    /// <summary>Objects of one label, with a model that tells its recorded pieces apart.</summary>
    public sealed class VariationTests : SceneTest
    {
        [Test]
        public void AnObjectWithAVariationDiffersFromItsLabelAndIsTheSameInEverySession()
        {
            float[] mean = Stroke(0f, 7);
            float[] varied = Stroke(1f, 7);
            Assert.That(mean.Max(), Is.GreaterThan(0f));
            Assert.That(varied, Is.Not.EqualTo(mean));
            Assert.That(Stroke(1f, 7), Is.EqualTo(varied));
            Assert.That(Stroke(0f, 7), Is.EqualTo(mean));
        }

        [Test]
        public void TheVariationIsLimitedToZeroToOne()
        {
            HapticSurface board = Board();
            board.Variation = 7f;
            Assert.That(board.Variation, Is.EqualTo(1f));
            board.Variation = -1f;
            Assert.That(board.Variation, Is.Zero);
        }

        /// <summary>The output of a stroke in a scene of its own.</summary>
        private float[] Stroke(float variation, uint seed)
        {
            EndScene();
            BeginScene();
            HaptoFlowSettings.Active.Model = HapticModelAsset.Create(
                File.ReadAllBytes(RepositoryFiles.In("Tests", "Golden", "model", "skeleton.haptoflow")));
            FinishLoading();
            HapticSurface board = Board("smooth", 2f);
            board.Variation = variation;
            board.Seed = seed;
            Output(out _);
            StylusAlong(seconds => new Vector3(0.15f * (float)seconds - 0.5f, 0.001f, 0f));
            World.Frames((int)(0.5 * World.FrameRateHz));
            AudioDevice.Forget();
            World.Frames((int)(1.0 * World.FrameRateHz));
            return AudioDevice.Samples();
        }
    }
}
