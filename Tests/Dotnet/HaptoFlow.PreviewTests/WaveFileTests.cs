using System;
using System.Linq;
using HaptoFlow.Preview;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
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
}
