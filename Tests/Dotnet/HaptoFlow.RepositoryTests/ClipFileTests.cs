using System;
using System.Linq;
using System.Text;
using NUnit.Framework;

namespace HaptoFlow.RepositoryTests
{
    /// <summary>Clips of the native library, as C# reads, makes, writes and plays them.</summary>
    public sealed class ClipFileTests : OpenModelTest
    {
        private static readonly DateTime Day = new DateTime(2026, 1, 2);
        // Compiled ahead of time, NUnit alone cannot make this array.
        private static readonly HapticClipFormat[] Formats =
            (HapticClipFormat[])Enum.GetValues(typeof(HapticClipFormat));

        [Test]
        public void AWaveIsWrittenAndReadInEveryFormat(
            [ValueSource(nameof(Formats))] HapticClipFormat format)
        {
            using HapticClipFile made = Hum(0.5);
            string text = made.Write(format, Day);
            using HapticClipFile read = HapticClipFile.Read(Encoding.UTF8.GetBytes(text));
            HapticClipInfo info = read.Info;
            Assert.That(info.Format, Is.EqualTo(format));
            Assert.That(info.DurationSeconds, Is.EqualTo(0.5).Within(0.03));
            Assert.That(info.Title + info.Description, Does.Contain("a test"));
            Assert.That(info.LargestAmplitude, Is.EqualTo(made.Info.LargestAmplitude).Within(0.05f));
            Assert.That(info.AmplitudePoints, Is.GreaterThan(1));
            Assert.That(info.Omitted, Is.Empty);
            var amplitude = new float[11];
            var frequencyHz = new float[11];
            read.Curves(amplitude, frequencyHz);
            Assert.That(frequencyHz[5], Is.EqualTo(150f).Within(6f));
            Assert.That(amplitude[5], Is.EqualTo(made.Info.LargestAmplitude).Within(0.05f));
            if (format == HapticClipFormat.Hjif)
            {
                Assert.That(text, Does.Contain("2026-01-02"));
            }
        }

        [TestCase(0)]
        [TestCase(-48000)]
        [TestCase(3000)]
        public void ARateThatNoWaveHasIsRefused(int rateHz) =>
            Assert.Throws<HaptoFlowException>(() => HapticClipFile.FromWave(new float[8], rateHz));

        [Test]
        public void AVoicePlaysAClipWithoutContactAndPlaysOnAfterItWasDisposed()
        {
            using HapticEngine engine = EngineWithoutWorker();
            using HapticVoice voice = engine.OpenVoice(48000.0);
            HapticClipFile clip = Hum(0.3);
            voice.PlayClip(clip);
            clip.Dispose();
            clip.Dispose();
            Assert.That(Peak(engine, voice, 6), Is.GreaterThan(0.1f), "the onset, a transient");
            Assert.That(Peak(engine, voice, 15), Is.EqualTo(0.1f).Within(0.02f));
            Peak(engine, voice, 10);
            Assert.That(Peak(engine, voice, 10), Is.Zero);
            EffectStatistics effect = voice.EffectStatistics(HapticEffect.Clip);
            Assert.That(effect.Events, Is.EqualTo(1UL));
            Assert.That(effect.IsAskedFor, Is.False);
        }

        [Test]
        public void ADisposedClipOrAGainOutOfRangeIsRefusedAndEndsNothing()
        {
            using HapticEngine engine = EngineWithoutWorker();
            using HapticVoice voice = engine.OpenVoice(48000.0);
            using HapticClipFile plays = Hum(1.0);
            HapticClipFile closed = Hum(0.1);
            closed.Dispose();
            voice.PlayClip(plays);
            Assert.That(Assert.Throws<HaptoFlowException>(() => voice.PlayClip(closed))!.Message,
                Does.Contain("disposed"));
            foreach (float gain in new[] { float.NaN, -0.1f, HapticClipFile.MaximumGain + 0.1f })
            {
                Assert.That(Assert.Throws<HaptoFlowException>(() => voice.PlayClip(plays, gain))!.Message,
                    Does.Contain("gain"));
            }
            Assert.That(Peak(engine, voice, 40), Is.GreaterThan(0.05f));
            Assert.Throws<HaptoFlowException>(() => closed.Wave(2000.0));
            Assert.That(closed.Info.DurationSeconds, Is.EqualTo(0.1).Within(0.01));
        }

        /// <summary>A sine of 150 Hz and 20 m/s^2, a tenth of full scale.</summary>
        private static HapticClipFile Hum(double seconds) => HapticClipFile.FromWave(
            Enumerable.Range(0, (int)(2000.0 * seconds))
                .Select(sample => 20f * (float)Math.Sin(2.0 * Math.PI * 150.0 * sample / 2000.0)).ToArray(),
            2000, "hum", "a test");

        private static float Peak(HapticEngine engine, HapticVoice voice, int blocks)
        {
            var block = new float[512];
            float peak = 0f;
            for (int count = 0; count < blocks; ++count)
            {
                Assert.That(voice.Publish(default), Is.True);
                engine.Step();
                Assert.That(voice.Render(block, 1, 0, 48000.0), Is.True);
                peak = Math.Max(peak, block.Max(sample => Math.Abs(sample)));
            }
            return peak;
        }
    }
}
