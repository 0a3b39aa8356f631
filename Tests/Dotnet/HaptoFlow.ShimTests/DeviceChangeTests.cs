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
    /// <summary>Outputs sound again after the audio engine was rebuilt, whatever it forgot of them.</summary>
    public sealed class DeviceChangeTests : SceneTest
    {
        private const float Audible = 0.001f;

        [SetUp]
        public void MakeABoard()
        {
            FinishLoading();
            Board();
        }

        [Test]
        public void TheVibrationReturnsWhereTheEngineDroppedTheFilterOrTheSource(
            [Values] bool dropsSources, [Values] bool besideListener)
        {
            GameObject owner = besideListener ? Ears() : Make("Output");
            owner.AddComponent<AudioSource>();
            owner.AddComponent<HapticOutput>();
            Circling();
            World.Frames(40);
            AudioDevice.DetachesFilters = true;
            AudioDevice.DetachesSources = dropsSources;
            foreach (int rateHz in new[] { 44100, 24000, 48000 })
            {
                AudioDevice.ChangeDevice(rateHz, 512, AudioSpeakerMode.Stereo);
                World.Frames(20);
                AudioDevice.Forget();
                World.Frames(40);
                Assert.That(AudioDevice.Peak(0), Is.GreaterThan(Audible), $"at {rateHz} Hz");
            }
            Assert.That(Log.Count("for a second", LogType.Warning), Is.Zero);
        }

        [Test]
        public void AChannelOnTheListenerAndTheNoiseBesideItReturn()
        {
            GameObject ears = Ears();
            var noise = ears.AddComponent<MaskingNoise>();
            var output = ears.AddComponent<HapticOutput>();
            (output.Route, output.Channel, noise.Output) = (OutputRoute.ListenerChannel, 1, output);
            Circling();
            World.Frames(40);
            AudioDevice.DetachesFilters = true;
            AudioDevice.ChangeDevice(44100, 512, AudioSpeakerMode.Stereo);
            World.Frames(20);
            AudioDevice.Forget();
            World.Frames(60);
            Assert.That(AudioDevice.Peak(1), Is.GreaterThan(Audible), "the vibration");
            Assert.That(AudioDevice.Peak(0), Is.GreaterThan(Audible), "the noise");
            AudioDevice.DropAll();
            LogAssert.Expect(LogType.Warning, new Regex("Listener is silent: for a second"));
            LogAssert.Expect(LogType.Warning, new Regex("the masking noise of Listener is silent: for a second"));
            World.Frames(120);
            AudioDevice.Forget();
            World.Frames(60);
            Assert.That((AudioDevice.Peak(0) > Audible, AudioDevice.Peak(1) > Audible), Is.EqualTo((true, true)), "both return");
        }

        [Test]
        public void EachBlockIsRenderedOnceWhereTheEngineKeptTheFilter([Values] OutputRoute route)
        {
            HapticOutput output = Ears().AddComponent<HapticOutput>();
            output.Route = route == OutputRoute.MixerEffect ? OutputRoute.AudioSource : route;
            output.Channel = 0;
            HapticStylus stylus = Circling();
            World.Frames(40);
            for (int change = 0; change < 3; ++change)
            {
                AudioDevice.ChangeDevice(48000, 256, AudioSpeakerMode.Stereo);
            }
            ulong before = StatisticsOf(stylus).RenderedFrames;
            AudioDevice.Forget();
            World.Frames(90);
            Assert.That(StatisticsOf(stylus).RenderedFrames - before, Is.EqualTo((ulong)AudioDevice.RecordedFrames));
        }

        [Test]
        public void AFilterThatWasReplacedRendersNothingThoughTheEngineStillCallsItInThatFrame()
        {
            int calls = 0;
            var filter = AudioFilter.AddTo(Make("Filter"), (_, _) => ++calls);
            var read = (Action<float[], int>)Delegate.CreateDelegate(
                typeof(Action<float[], int>), filter, "OnAudioFilterRead");
            read(new float[8], 2);
            filter.Retire();
            read(new float[8], 2);
            Assert.That(calls, Is.EqualTo(1));
        }

        [Test]
        public void FiltersThatAreDroppedWithoutAWordAreMissedAfterASecondAndMadeAnew()
        {
            Output(out HapticOutput output);
            Circling();
            World.Frames(40);
            AudioDevice.DropAll();
            World.Frames(80);
            Assert.That(Log.Count("for a second", LogType.Warning), Is.Zero, "not within the second");
            LogAssert.Expect(LogType.Warning, new Regex("Output is silent: for a second, .*AudioSettings.Reset"));
            World.Frames(30);
            AudioDevice.Forget();
            World.Frames(40);
            Assert.That(AudioDevice.Peak(0), Is.GreaterThan(Audible));
            Assert.That(output.transform.childCount, Is.EqualTo(1));
            AudioDevice.DropAll();
            LogAssert.Expect(LogType.Warning, new Regex("for a second"));
            World.Frames(120);
            Assert.That(Log.Count("for a second", LogType.Warning), Is.EqualTo(2), "another silence is another sentence");
        }

        [Test]
        public void ASilenceThatStaysIsSaidOnceAndTriedOnce()
        {
            HapticOutput output = Make("Output").AddComponent<HapticOutput>();
            (output.Route, output.Channel) = (OutputRoute.ListenerChannel, 0);
            LogAssert.Expect(LogType.Warning, new Regex("Output is silent: .*Audio Listener that is in use"));
            World.Frames(900);
            Assert.That(Log.Count("for a second", LogType.Warning), Is.EqualTo(1));
            Assert.That(AudioDevice.AllocatedBytes, Is.Zero);
        }

        [Test]
        public void AHitchOrASuspendedApplicationIsNoSilence()
        {
            Output(out _);
            Circling();
            World.Frames(20);
            AudioListener.pause = true;
            World.Frames(300);
            AudioListener.pause = false;
            World.Frame(30.0);
            World.Frames(30);
            Assert.That(Log.Count("", LogType.Warning), Is.Zero);
        }

        [Test]
        public void TheMixerEffectIsToldItsVoiceAgainAfterTheMixerWasLoadedAnew()
        {
            var mixer = new AudioMixer();
            mixer.Exposed["Pen"] = -1f;
            Output(out HapticOutput output);
            output.Route = OutputRoute.MixerEffect;
            output.SetMixer(mixer, "Pen");
            Circling();
            World.Frames(10);
            float voice = mixer.Exposed["Pen"];
            Assert.That(voice, Is.GreaterThanOrEqualTo(0f));
            mixer.Exposed["Pen"] = -1f;
            AudioDevice.ChangeDevice(44100, 512, AudioSpeakerMode.Stereo);
            Assert.That(mixer.Exposed["Pen"], Is.EqualTo(voice));
            mixer.Exposed["Pen"] = -1f;
            LogAssert.Expect(LogType.Warning, new Regex("Output is silent: for a second, .*auto-suspend"));
            World.Frames(120);
            Assert.That(mixer.Exposed["Pen"], Is.EqualTo(voice), "no group has called the effect for a second");
        }

        private static GameObject Ears() => All<AudioListener>()[0].gameObject;
    }
}
