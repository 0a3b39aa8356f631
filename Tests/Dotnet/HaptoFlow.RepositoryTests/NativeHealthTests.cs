using System;
using System.Linq;
using System.Runtime.InteropServices;
using HaptoFlow.Native;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

namespace HaptoFlow.RepositoryTests
{
    /// <summary>Reasons for silence, the health of the engine and cancelled loads, with the real library.</summary>
    public sealed class NativeHealthTests : OpenModelTest
    {
        [Test]
        public void AVoiceReportsWhyItIsSilent()
        {
            using HapticEngine engine = EngineWithoutWorker();
            using HapticVoice voice = engine.OpenVoice(48000.0);
            Assert.That(After(engine, voice, default, 48000.0).Silence, Is.EqualTo(HapticSilence.Rest));
            Assert.That(After(engine, voice, Sliding(1), 48000.0).Silence, Is.EqualTo(HapticSilence.None));
            voice.SetMuted(true);
            Assert.That(After(engine, voice, Sliding(1), 48000.0).Silence, Is.EqualTo(HapticSilence.Muted));
            voice.SetMuted(false);
            VoiceStatistics again = After(engine, voice, Sliding(1), 48000.0);
            Assert.That(again.Silence, Is.EqualTo(HapticSilence.None));
            Assert.That(again.Resumptions, Is.EqualTo(1UL));
            voice.Panic();
            Assert.That(After(engine, voice, Sliding(1), 48000.0).Silence, Is.EqualTo(HapticSilence.Panic));
            voice.SetPaused(true);
            Assert.That(After(engine, voice, Sliding(2), 48000.0).Silence, Is.EqualTo(HapticSilence.Paused));
        }

        [Test]
        public void AnUnsupportedRateIsCountedAndReported()
        {
            using HapticEngine engine = EngineWithoutWorker();
            using HapticVoice voice = engine.OpenVoice(48000.0);
            VoiceStatistics good = After(engine, voice, Sliding(1), 48000.0);
            Assert.That(good.IsRateSupported, Is.True);
            Assert.That(good.DeviceRateHz, Is.EqualTo(48000.0));
            VoiceStatistics bad = After(engine, voice, Sliding(1), 384000.0);
            Assert.That(bad.IsRateSupported, Is.False);
            Assert.That(bad.Silence, Is.EqualTo(HapticSilence.Rate));
            Assert.That(bad.UnsupportedRateBlocks, Is.GreaterThan(0UL));
            Assert.That(bad.DeviceRateHz, Is.EqualTo(384000.0));
        }

        [Test]
        public void AHealthyEngineReportsNoProblem()
        {
            using HapticEngine engine = new HapticEngine(
                runtime, model, new HapticEngineOptions { Quality = HapticQuality.Draft });
            Assert.That(engine.Statistics().WorkerIsAlive, Is.True);
            Assert.That(engine.LastFailure(), Is.Empty);
            using HapticEngine stepped = EngineWithoutWorker();
            Assert.That(stepped.Statistics().WorkerIsAlive, Is.True);
        }

        [TestCase(-1)]
        [TestCase(3)]
        [TestCase(5)]
        public void ANumberThatIsNoQualityIsRefusedByTheEngineAndIsStandardInAnAsset(int number)
        {
            using HapticEngine engine = EngineWithoutWorker();
            Assert.That(Assert.Throws<HaptoFlowException>(() => engine.SetQuality((HapticQuality)number))!.Message,
                Does.Contain(FormattableString.Invariant(
                    $"quality is {number}; expected 0 (auto), 1 (draft), 2 (standard) or 4 (sketch)")));
            Assert.That(((HapticQuality)number).OrStandard(), Is.EqualTo(HapticQuality.Standard));
        }

        [Test]
        public void EveryQualityThatThereIsStaysWhatItIs()
        {
            foreach (HapticQuality quality in (HapticQuality[])Enum.GetValues(typeof(HapticQuality)))
            {
                Assert.That(quality.OrStandard(), Is.EqualTo(quality));
            }
        }

        [Test]
        public void ACancelledLoadReturnsTheStatusCancelled()
        {
            using var cancellation = new HapticCancellation();
            using (EngineWithoutWorker(cancellation))
            {
                // A cancellation that is not triggered changes nothing.
            }
            cancellation.Cancel();
            cancellation.Cancel();
            Assert.That(Assert.Throws<HaptoFlowException>(() => EngineWithoutWorker(cancellation))!.Status,
                Is.EqualTo(HaptoFlowStatus.Cancelled));
        }

        [Test]
        public void AClosedCancellationIsRefused()
        {
            var cancellation = new HapticCancellation();
            cancellation.Dispose();
            cancellation.Dispose();
            Assert.That(Assert.Throws<HaptoFlowException>(() => cancellation.Cancel())!.Status,
                Is.EqualTo(HaptoFlowStatus.InvalidArgument));
        }


        private static VoiceStatistics After(
            HapticEngine engine, HapticVoice voice, in ContactState state, double rateHz)
        {
            var block = new float[512];
            for (int count = 0; count < 10; ++count)
            {
                voice.Publish(state);
                engine.Step();
                voice.Render(block, 1, 0, rateHz);
            }
            return voice.Statistics();
        }
    }
}
