using System;
using System.Linq;
using System.Text.RegularExpressions;
using HaptoFlow.Studies;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;
using UnityShim;

namespace HaptoFlow.ShimTests
{
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
