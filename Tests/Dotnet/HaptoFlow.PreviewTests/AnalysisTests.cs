#nullable enable
using System;
using System.IO;
using System.Linq;
using System.Numerics;
using System.Text;
using System.Threading;
using HaptoFlow.Editor;
using HaptoFlow.Preview;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    public sealed class AnalysisTests
    {
        private static PreviewSound Sound(Func<double, double> mps2, double contactSeconds = 2.0)
        {
            Stroke stroke = PresetStrokes.Make(StrokePreset.Slide, new StrokeSettings(0.1, 1.0, 0.0, contactSeconds));
            var samples = new float[(int)(stroke.DurationSeconds * PreviewSound.RateHz)];
            for (int index = 0; index < samples.Length; ++index)
            {
                samples[index] = (float)(mps2(index / (double)PreviewSound.RateHz) / PreviewSound.FullScaleMps2);
            }
            return new PreviewSound(new LabelMix("made"), stroke, samples);
        }

        private static Func<double, double> Sine(double amplitude, double hertz) =>
            seconds => amplitude * Math.Sin(2.0 * Math.PI * hertz * seconds);

        [Test]
        public void TheTransformEqualsItsDefiningSum()
        {
            var random = new Random(1);
            Complex[] values = Enumerable.Range(0, 64)
                .Select(_ => new Complex(random.NextDouble() - 0.5, random.NextDouble() - 0.5)).ToArray();
            Complex[] expected = Enumerable.Range(0, 64).Select(bin => Enumerable.Range(0, 64)
                .Select(index => values[index] * Complex.FromPolarCoordinates(1.0, -2.0 * Math.PI * bin * index / 64.0))
                .Aggregate(Complex.Zero, (sum, each) => sum + each)).ToArray();
            new Fourier(64).Transform(values);
            Assert.That(values.Select(each => each.Real), Is.EqualTo(expected.Select(each => each.Real)).Within(1e-12));
            Assert.That(values.Select(each => each.Imaginary),
                Is.EqualTo(expected.Select(each => each.Imaginary)).Within(1e-12));
        }

        [Test]
        public void SamplesPastTheEndAreZero()
        {
            var densities = new double[100];
            new PowerDensity(1024, 48000.0).Of(new float[] { 1f, 1f, 1f }, 5000, densities);
            Assert.That(densities, Is.All.Zero);
        }

        [Test]
        public void TheDensityOfASineHasItsPowerAndItsPeak()
        {
            Spectrum spectrum = Spectrum.Of(Sound(Sine(4.0, 250.0)), CancellationToken.None);
            double power = Enumerable.Range(0, spectrum.Bins)
                .Sum(bin => Math.Pow(10.0, spectrum.Decibels(bin * spectrum.HertzPerBin) / 10.0));
            power *= spectrum.HertzPerBin;
            Assert.That(power, Is.EqualTo(8.0).Within(0.02));
            double peak = Enumerable.Range(20, 981).OrderByDescending(hertz => spectrum.Decibels(hertz)).First();
            Assert.That(peak, Is.EqualTo(250.0).Within(spectrum.HertzPerBin));
        }

        [Test]
        public void TheSpectrumIgnoresTimeWithoutContact()
        {
            Func<double, double> sine = Sine(4.0, 250.0);
            double Level(double contactSeconds) => Spectrum.Of(
                Sound(time => time < 0.1 || time > 0.1 + contactSeconds ? 0.0 : sine(time), contactSeconds),
                CancellationToken.None).Decibels(250.0);

            Assert.That(Level(0.8), Is.EqualTo(Level(4.0)).Within(0.8));
        }

        [Test]
        public void ANarrowBandContainsItsHighestBin()
        {
            Spectrum spectrum = Spectrum.Of(Sound(Sine(1.0, 300.0)), CancellationToken.None);
            double highest = SpectrumChart.Highest(spectrum);
            Assert.That(spectrum.DecibelsBetween(200.0, 400.0), Is.EqualTo(highest));
            Assert.That(spectrum.DecibelsBetween(100.0, 100.1), Is.LessThan(highest - 40.0));
        }

        [Test]
        public void TheSpectrogramShowsEachSineAtItsTime()
        {
            PreviewSound sound = Sound(seconds => Sine(1.0, seconds < 1.0 ? 100.0 : 700.0)(seconds));
            Spectrogram spectrogram = Spectrogram.Of(sound, CancellationToken.None);
            double Loudest(double seconds)
            {
                var column = (int)(seconds / sound.DurationSeconds * spectrogram.Columns);
                return Enumerable.Range(0, spectrogram.Rows)
                    .OrderByDescending(row => spectrogram.Decibels(column, row)).First() * spectrogram.HertzPerRow;
            }

            Assert.That(Loudest(0.5), Is.EqualTo(100.0).Within(spectrogram.HertzPerRow));
            Assert.That(Loudest(1.5), Is.EqualTo(700.0).Within(spectrogram.HertzPerRow));
            Assert.That(spectrogram.Columns, Is.EqualTo(230).Within(2), "the hop is 10 ms");
        }

        [Test]
        public void SilenceHasALevelOfMinusInfinity()
        {
            PreviewSound silence = Sound(_ => 0.0);
            Spectrum spectrum = Spectrum.Of(silence, CancellationToken.None);
            Assert.That(spectrum.Decibels(100.0), Is.EqualTo(double.NegativeInfinity));
            Assert.That(Levels.Top(double.NegativeInfinity), Is.Zero);
            Assert.That((silence.RmsMps2, silence.PeakMps2), Is.EqualTo((0.0, 0.0)));
        }

        [Test]
        public void RmsCountsOnlySamplesDuringContact()
        {
            Func<double, double> sine = Sine(3.0, 200.0);
            PreviewSound sound = Sound(time => time < 0.1 || time > 2.1 ? 0.0 : sine(time));
            Assert.That(sound.RmsMps2, Is.EqualTo(3.0 / Math.Sqrt(2.0)).Within(0.02));
            Assert.That(sound.PeakMps2, Is.EqualTo(3.0).Within(0.001));
        }

        [TestCase(0.0, 10.0)]
        [TestCase(-3.0, 0.0)]
        [TestCase(-2.9, 10.0)]
        [TestCase(-41.0, -30.0)]
        public void TheLevelAxisEndsAtAMultipleOfTenAtLeastThreeAbove(double highest, double expected) =>
            Assert.That(Levels.Top(highest), Is.EqualTo(expected));
    }

    public sealed class WaveFileTests
    {
        [Test]
        public void AWaveFileHasTheHeaderOfSinglePrecisionNumbersThenItsSamples([Values(0, 999)] int count)
        {
            float[] samples = Enumerable.Range(0, count).Select(index => index / 999f - 0.5f).ToArray();
            using var file = new BinaryReader(new MemoryStream(WaveFile.Bytes(samples, 48000)), Encoding.ASCII);
            string Tag() => new string(file.ReadChars(4));
            Assert.That((Tag(), file.ReadInt32(), Tag()), Is.EqualTo(("RIFF", file.BaseStream.Length - 8, "WAVE")));
            Assert.That((Tag(), file.ReadInt32()), Is.EqualTo(("fmt ", 18)));
            Assert.That((file.ReadInt16(), file.ReadInt16()), Is.EqualTo((3, 1)), "numbers, one channel");
            Assert.That((file.ReadInt32(), file.ReadInt32()), Is.EqualTo((48000, 192000)), "a second");
            Assert.That((file.ReadInt16(), file.ReadInt16(), file.ReadInt16()), Is.EqualTo((4, 32, 0)));
            Assert.That((Tag(), file.ReadInt32(), file.ReadInt32()), Is.EqualTo(("fact", 4, count)));
            Assert.That((Tag(), file.ReadInt32()), Is.EqualTo(("data", 4 * count)));
            Assert.That(samples.Select(_ => file.ReadSingle()), Is.EqualTo(samples));
            Assert.That(file.BaseStream.Position, Is.EqualTo(file.BaseStream.Length));
        }
    }
}
