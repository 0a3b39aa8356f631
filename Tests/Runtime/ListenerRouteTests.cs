#nullable enable
using System;
using System.Collections;
using System.Text.RegularExpressions;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;

namespace HaptoFlow.Tests
{
    /// <summary>Interactions of the haptics with the rest of a game's sound.</summary>
    public sealed class ListenerRouteTests : SceneTest
    {
        private const float Audible = 0.001f;

        [UnityTest]
        public IEnumerator AListenerRouteWithoutAChannelIsSilentAndLogsAnError()
        {
            FinishLoading();
            LogAssert.Expect(LogType.Error, new Regex("Ears is silent: .*Choose a channel"));
            AudioTap tap = Ears(out HapticOutput output);
            Board();
            Circling().Output = output;
            yield return Frames(40);
            Assert.That(tap.Blocks, Is.GreaterThan(0));
            Assert.That(tap.Peak(0), Is.EqualTo(0.25f).Within(1e-6f));
            Assert.That(tap.Peak(1), Is.EqualTo(0.25f).Within(1e-6f));
            output.Channel = 1;
            yield return Frames(5);
            tap.Restart();
            yield return Frames(40);
            Assert.That(tap.Peak(0), Is.EqualTo(0.25f).Within(1e-6f));
            Assert.That(tap.Peak(1), Is.Not.EqualTo(0.25f).Within(1e-6f), "the channel carries the haptics");
        }

        [UnityTest]
        public IEnumerator RemovingTheChannelOfARunningListenerRouteLogsAnError()
        {
            FinishLoading();
            LogAssert.Expect(LogType.Error, new Regex("Ears is silent"));
            AudioTap tap = Ears(out HapticOutput output);
            output.Channel = 1;
            yield return Frames(10);
            output.Channel = HapticVoice.AllChannels;
            yield return Frames(5);
            tap.Restart();
            yield return Frames(10);
            Assert.That(tap.Peak(0), Is.EqualTo(0.25f).Within(1e-6f));
            Assert.That(tap.Peak(1), Is.EqualTo(0.25f).Within(1e-6f));
        }

        [UnityTest]
        public IEnumerator APausedListenerAtVolumeZeroDoesNotSilenceTheHaptics()
        {
            FinishLoading();
            Board();
            AudioTap tap = Output(out HapticOutput output);
            Circling();
            yield return null;
            AudioListener.pause = true;
            AudioListener.volume = 0f;
            yield return Frames(40);
            Assert.That(tap.Blocks, Is.GreaterThan(0));
            Assert.That(tap.Peak(), Is.GreaterThan(Audible));
            Assert.That(output.GetComponent<AudioSource>().ignoreListenerVolume, Is.True);
            output.ObeyListener = true;
            yield return null;
            tap.Restart();
            yield return Frames(10);
            Assert.That(tap.Blocks, Is.Zero, "with ObeyListener the source pauses with the listener");
            Assert.That(output.GetComponent<AudioSource>().ignoreListenerVolume, Is.False);
            AudioListener.pause = false;
            AudioListener.volume = 1f;
        }

        [UnityTest]
        public IEnumerator ASourceBypassesTheListenersEffectsAndNotItsOwn()
        {
            FinishLoading();
            Board();
            GameObject owner = Make("Output");
            owner.AddComponent<AudioSource>().bypassEffects = true;
            var output = owner.AddComponent<HapticOutput>();
            Circling();
            yield return Frames(40);
            var source = owner.GetComponent<AudioSource>();
            Assert.That(source.bypassEffects, Is.False, "the output is a filter of its source");
            Assert.That(source.bypassListenerEffects && source.bypassReverbZones, Is.True);
            Assert.That(output.Level, Is.GreaterThan(Audible));
        }

        [UnityTest]
        public IEnumerator ASourceBesideTheListenerPlaysOnceAndLeavesOtherSoundsAlone()
        {
            FinishLoading();
            Board();
            GameObject music = Make("Music");
            music.AddComponent<AudioSource>();
            music.AddComponent<SteadySource>();
            GameObject listener = UnityEngine.Object.FindObjectsByType<AudioListener>(
                FindObjectsInactive.Exclude, FindObjectsSortMode.None)[0].gameObject;
            var output = listener.AddComponent<HapticOutput>();
            var tap = listener.AddComponent<AudioTap>();
            HapticStylus stylus = Circling();
            yield return Frames(5);
            tap.Restart();
            stylus.TryGetStatistics(out VoiceStatistics before);
            yield return Frames(40);
            Assert.That(tap.Peak(0), Is.EqualTo(0.25f).Within(1e-6f), "the game's sound");
            Assert.That(output.Level, Is.GreaterThan(Audible), "the haptics");
            Assert.That(stylus.TryGetStatistics(out VoiceStatistics after), Is.True);
            AudioSettings.GetDSPBufferSize(out int blockFrames, out _);
            Assert.That(after.RenderedFrames - before.RenderedFrames,
                Is.EqualTo((ulong)(tap.Blocks * blockFrames)).Within(4 * blockFrames), "each block is rendered once");
            output.enabled = false;
            output.enabled = true;
            yield return Frames(5);
            Assert.That(output.transform.childCount, Is.EqualTo(1), "no second source");
        }

        private AudioTap Ears(out HapticOutput output)
        {
            GameObject listener = Make("Ears");
            listener.AddComponent<AudioSource>();
            listener.AddComponent<SteadySource>();
            output = listener.AddComponent<HapticOutput>();
            output.Route = OutputRoute.ListenerChannel;
            return listener.AddComponent<AudioTap>();
        }

        private static IEnumerator Frames(int count)
        {
            for (int frame = 0; frame < count; ++frame)
            {
                yield return null;
            }
        }
    }
}
