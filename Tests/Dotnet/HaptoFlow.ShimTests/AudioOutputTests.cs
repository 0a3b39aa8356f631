using System;
using System.Linq;
using System.Text.RegularExpressions;
using HaptoFlow.Studies;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.Audio;
using UnityEngine.TestTools;
using UnityShim;

namespace HaptoFlow.ShimTests
{
    public sealed class SignalOutputTests : SceneTest
    {
        private HapticOutput output = null!;

        [SetUp]
        public void CreateAnOutput()
        {
            Output(out output);
            Board();
        }

        [Test]
        public void TheSineHasItsAmplitudeWhileTheTipMovesAndNoInferenceRuns()
        {
            output.SetSignal(200.0, 20.0);
            HapticStylus stylus = Circling();
            FinishLoading();
            World.Frames(45);
            AudioDevice.Forget();
            World.Frames(45);
            float[] samples = AudioDevice.Samples();
            Assert.That(samples.Max(), Is.EqualTo(20.0 / HapticEngineOptions.DefaultFullScaleMps2).Within(1e-3));
            double rms = Math.Sqrt(samples.Average(sample => (double)sample * sample));
            Assert.That(rms, Is.EqualTo(samples.Max() / Math.Sqrt(2.0)).Within(1e-3), "a sine without interruption");
            Assert.That(StatisticsOf(stylus).Inferences, Is.Zero);
            Assert.That(stylus.TryGetSignalStatistics(out SignalStatistics signal), Is.True);
            Assert.That(signal.Starts, Is.EqualTo(1ul));
        }

        [Test]
        public void ASignalCanBeSetAndRemovedWhileAVoiceIsOpen()
        {
            HapticStylus stylus = Circling();
            FinishLoading();
            World.Frames(45);
            output.SetSignal(200.0, 20.0);
            World.Frames(45);
            Assert.That(RunsOf(stylus), Is.GreaterThan(0ul));
            output.SetSignal(0.0, 0.0);
            World.Frames(5);
            ulong before = RunsOf(stylus);
            AudioDevice.Forget();
            World.Frames(45);
            Assert.That(RunsOf(stylus), Is.EqualTo(before));
            Assert.That(AudioDevice.Samples().Max(), Is.GreaterThan(0.001f), "the texture is felt again");
        }

        [TestCase(0.0, 20.0)]
        [TestCase(501.0, 20.0)]
        [TestCase(double.NaN, 20.0)]
        [TestCase(200.0, 61.0)]
        [TestCase(200.0, -1.0)]
        [TestCase(200.0, double.NaN)]
        public void ASignalOutOfRangeIsRefused(double frequencyHz, double amplitudeMps2) => Assert.That(
            () => output.SetSignal(frequencyHz, amplitudeMps2), Throws.TypeOf<ArgumentOutOfRangeException>());

        private static ulong RunsOf(HapticStylus stylus) => StatisticsOf(stylus, HapticEffect.Signal).Runs;
    }

    public sealed class MixerEffectTests : SceneTest
    {
        [Test]
        public void TheMixerEffectGetsTheVoiceAndRendersIt()
        {
            FinishLoading();
            Board();
            AudioTap tap = Output(out HapticOutput output);
            var mixer = new AudioMixer();
            mixer.Exposed["Pen"] = -1f;
            output.Route = OutputRoute.MixerEffect;
            output.SetMixer(mixer, "Pen");
            HapticStylus other = StylusAlong(_ => new Vector3(0f, 1f, 0f));
            World.Frames(3);
            // Voices of another scene that still fade have slots, too.
            float slotOfOther = mixer.Exposed["Pen"];
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0.05f * (float)seconds, 0.001f, 0f));
            World.Frames(30);
            Assert.That(slotOfOther, Is.GreaterThanOrEqualTo(0f));
            Assert.That(mixer.Exposed["Pen"], Is.GreaterThanOrEqualTo(0f).And.Not.EqualTo(slotOfOther), "the slot of the second voice");
            Assert.That(tap.Peak(), Is.Zero);
            Assert.That(StatisticsOf(stylus).RenderedFrames, Is.Zero);
            Assert.That(other.TryGetStatistics(out _), Is.True);
        }

        [Test]
        public void AMixerWithoutTheParameterIsLogged()
        {
            FinishLoading();
            Output(out HapticOutput output);
            output.Route = OutputRoute.MixerEffect;
            output.SetMixer(new AudioMixer(), "Pen");
            StylusAlong(_ => Vector3.up);
            World.Frames(3);
            Assert.That(Log.Count("\"Pen\"", LogType.Warning), Is.EqualTo(1));
        }
    }

    /// <summary>Projects with FMOD or Wwise switch Unity's audio off; pause menus pause it.</summary>
    public sealed class UnityAudioOffTests : HeldDeviceTest
    {
        [Test]
        public void OneSentenceSaysThatUnitysAudioIsOffHoweverManyOutputsThereAre()
        {
            AudioDevice.IsSwitchedOff = true;
            Output(out HapticOutput first);
            Output(out HapticOutput second);
            (first.Channel, second.Channel) = (0, 1);
            second.Route = OutputRoute.ListenerChannel;
            LogAssert.Expect(LogType.Warning, new Regex("Output is silent: Unity's audio does not run, .*Disable Unity " +
                "Audio.*FMOD and Wwise"));
            World.Frames(600);
            Assert.That(Log.Lines.Count(line => line.Type != LogType.Log), Is.EqualTo(1));
        }

        [Test]
        public void WithoutAnOutputOneSentenceNamesTheStylusAndNoOutputIsMadeUntilTheAudioRuns()
        {
            AudioDevice.IsSwitchedOff = true;
            LogAssert.Expect(LogType.Warning, new Regex("Stylus is silent: Unity's audio does not run"));
            World.Frames(200);
            Assert.That(Log.Lines, Has.Count.EqualTo(1));
            Assert.That(All<HapticOutput>(), Is.Empty);
            AudioDevice.IsSwitchedOff = false;
            World.Frames(20);
            Assert.That(All<HapticOutput>(), Has.Length.EqualTo(1));
        }

        [Test]
        public void DeviceOutputsGoOnWithAClockOfTheirOwn()
        {
            AudioDevice.IsSwitchedOff = true;
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            XrHand.Right.Take("The same controller", true);
            Output(out _);
            Add<ControllerWaveformOutput>();
            Add<MotorOutput>();
            World.Frames(144);
            Assert.That(OVRInput.Waves.Count, Is.GreaterThan(60));
            Assert.That(OVRInput.Waves.Max(wave => wave.Samples.Max(Math.Abs)), Is.GreaterThan(0.01f));
            Assert.That(XrHand.Right.Impulses.Max(each => each.Amplitude), Is.GreaterThan(0.01f));
        }

        [Test]
        public void AStudyRefusesWithTheReason()
        {
            AudioDevice.IsSwitchedOff = true;
            Output(out HapticOutput output);
            output.Channel = 1;
            MaskingNoise noise = Make("Ears").AddComponent<MaskingNoise>();
            noise.Output = output;
            World.Frames(3);
            Assert.That(noise.Problem, Does.Contain("Disable Unity Audio"));
            Assert.That(StudyPlayer.BlockMilliseconds, Is.GreaterThan(0.0).And.LessThan(100.0));
        }

        [Test]
        public void AClockThatStandsStillIsRecognisedAndWhenItRunsAgainTheOutputSounds()
        {
            Output(out HapticOutput output);
            output.Channel = 0;
            World.Frames(40);
            AudioDevice.StandsStill = true;
            LogAssert.Expect(LogType.Warning, new Regex("there is no audio output"));
            World.Frames(120);
            Assert.That(UnityAudio.Problem, Is.Not.Null);
            AudioDevice.StandsStill = false;
            World.Frames(20);
            Assert.That(UnityAudio.Problem, Is.Null);
            AudioDevice.Forget();
            World.Frames(20);
            Assert.That(AudioDevice.Peak(), Is.GreaterThan(0.001f));
        }

        [Test]
        public void APauseMenuSilencesTheDeviceAtOnceAndItReturnsAfterwards()
        {
            OVRPlugin.Connected = OVRPlugin.Controller.RTouch;
            XrHand.Right.Take("The same controller", true);
            Add<ControllerWaveformOutput>();
            MotorOutput motor = Add<MotorOutput>();
            motor.PlayWhilePaused = true;
            World.Frames(60);
            Time.timeScale = 0f;
            AudioListener.pause = true;
            World.Frames(2);
            OVRInput.Waves.Clear();
            XrHand.Right.Impulses.Clear();
            World.Frames(72);
            Assert.That(OVRInput.Waves.SelectMany(wave => wave.Samples).Select(Math.Abs).DefaultIfEmpty().Max(), Is.Zero);
            Assert.That(XrHand.Right.Impulses.Max(each => each.Amplitude), Is.GreaterThan(0.01f), "it plays while paused");
            Time.timeScale = 1f;
            AudioListener.pause = false;
            World.Frames(60);
            Assert.That(OVRInput.Waves.Max(wave => wave.Samples.Max(Math.Abs)), Is.GreaterThan(0.01f));
        }
    }
}
