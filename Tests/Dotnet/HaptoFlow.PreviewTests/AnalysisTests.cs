#nullable enable
using System;
using System.Buffers.Binary;
using System.Collections.Generic;
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
        public void AWaveFileReadsBackWithTheSameSamples()
        {
            var random = new Random(4);
            float[] samples = Enumerable.Range(0, 999).Select(_ => (float)(2.0 * random.NextDouble() - 1.0)).ToArray();
            var file = new WaveReader(WaveFile.Bytes(samples, 48000));
            Assert.That(file.Samples(), Is.EqualTo(samples));
            Assert.That((file.Format, file.Channels, file.RateHz, file.BitsPerSample), Is.EqualTo((3, 1, 48000, 32)));
            Assert.That((file.BytesPerSecond, file.BlockBytes), Is.EqualTo((192000, 4)));
            Assert.That(file.FactSamples, Is.EqualTo(999));
        }

        [Test]
        public void ASoundWithoutSamplesIsAValidFile() =>
            Assert.That(new WaveReader(WaveFile.Bytes(Array.Empty<float>(), 48000)).Samples(), Is.Empty);
    }

    /// <summary>Reads RIFF WAVE files by the format's rules, independently of the writer under test.</summary>
    internal sealed class WaveReader
    {
        private readonly Dictionary<string, byte[]> chunks = new Dictionary<string, byte[]>();

        public WaveReader(byte[] file)
        {
            Assert.That(Tag(file, 0), Is.EqualTo("RIFF"));
            Assert.That(Number(file, 4), Is.EqualTo(file.Length - 8));
            Assert.That(Tag(file, 8), Is.EqualTo("WAVE"));
            int place = 12;
            while (place < file.Length)
            {
                int bytes = Number(file, place + 4);
                chunks.Add(Tag(file, place), file.AsSpan(place + 8, bytes).ToArray());
                place += 8 + bytes + (bytes & 1);
            }
            Assert.That(place, Is.EqualTo(file.Length));
        }

        public int Format => Short(0);

        public int Channels => Short(2);

        public int RateHz => Number(chunks["fmt "], 4);

        public int BytesPerSecond => Number(chunks["fmt "], 8);

        public int BlockBytes => Short(12);

        public int BitsPerSample => Short(14);

        public int FactSamples => Number(chunks["fact"], 0);

        public float[] Samples()
        {
            byte[] data = chunks["data"];
            var samples = new float[data.Length / 4];
            for (int index = 0; index < samples.Length; ++index)
            {
                samples[index] = BitConverter.Int32BitsToSingle(Number(data, 4 * index));
            }
            return samples;
        }

        private int Short(int place) => BinaryPrimitives.ReadInt16LittleEndian(chunks["fmt "].AsSpan(place));

        private static int Number(byte[] bytes, int place) =>
            BinaryPrimitives.ReadInt32LittleEndian(bytes.AsSpan(place));

        private static string Tag(byte[] bytes, int place) => Encoding.ASCII.GetString(bytes, place, 4);
    }
}
