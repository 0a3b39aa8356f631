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
        public IEnumerator AListenerAtVolumeZeroSilencesNoHapticsUnlessTheyObeyIt()
        {
            FinishLoading();
            Board();
            Output(out HapticOutput output);
            Circling();
            yield return null;
            var source = output.GetComponentInChildren<AudioSource>(true);
            Assert.That(source.ignoreListenerVolume, Is.True);
            output.ObeyListener = true;
            Assert.That(source.ignoreListenerVolume, Is.False);
        }

        [UnityTest]
        public IEnumerator APauseMenuSilencesTheHapticsAndTheyReturnAfterwards()
        {
            FinishLoading();
            Board();
            Output(out HapticOutput output);
            HapticStylus stylus = Circling();
            yield return Frames(40);
            Assert.That(output.Level, Is.GreaterThan(Audible));
            Time.timeScale = 0f;
            AudioListener.pause = true;
            yield return Frames(20);
            Assert.That(stylus.TryGetStatistics(out VoiceStatistics before), Is.True);
            Assert.That(before.Silence, Is.EqualTo(HapticSilence.Paused));
            yield return Frames(60);
            Assert.That(output.Level, Is.LessThan(Audible));
            stylus.TryGetStatistics(out VoiceStatistics paused);
            Assert.That(paused.Inferences, Is.EqualTo(before.Inferences), "a pause costs nothing");
            Time.timeScale = 1f;
            AudioListener.pause = false;
            yield return Frames(40);
            Assert.That(output.Level, Is.GreaterThan(Audible));
        }

        [UnityTest]
        public IEnumerator AnOutputThatPlaysWhilePausedGoesOnInAPauseMenu()
        {
            FinishLoading();
            Board();
            Output(out HapticOutput output);
            output.PlayWhilePaused = true;
            Circling();
            Time.timeScale = 0f;
            AudioListener.pause = true;
            yield return Frames(60);
            Assert.That(output.Level, Is.GreaterThan(Audible));
            output.PlayWhilePaused = false;
            yield return Frames(60);
            Assert.That(output.Level, Is.LessThan(Audible), "the switch acts during the pause");
            Time.timeScale = 1f;
            AudioListener.pause = false;
        }

        [UnityTest]
        public IEnumerator AnApplicationThatReturnsIntoAPauseMenuStaysSilent()
        {
            FinishLoading();
            Board();
            Output(out HapticOutput output);
            Circling();
            AudioListener.pause = true;
            yield return Frames(10);
            output.SendMessage("OnApplicationPause", true);
            output.SendMessage("OnApplicationPause", false);
            yield return Frames(60);
            Assert.That(output.Level, Is.LessThan(Audible));
            AudioListener.pause = false;
        }

        [UnityTest]
        public IEnumerator TheAuthorsSourceOnTheOutputsObjectIsLeftAlone()
        {
            FinishLoading();
            Board();
            GameObject owner = Make("Radio");
            var music = owner.AddComponent<AudioSource>();
            (music.spatialBlend, music.priority, music.dopplerLevel, music.bypassEffects) = (1f, 200, 0.5f, true);
            var tone = owner.AddComponent<SteadySource>();
            var output = owner.AddComponent<HapticOutput>();
            Circling();
            yield return Frames(40);
            Assert.That(output.Level, Is.GreaterThan(Audible));
            Assert.That((music.spatialBlend, music.priority, music.dopplerLevel, music.bypassEffects, music.playOnAwake),
                Is.EqualTo((1f, 200, 0.5f, true, true)));
            Assert.That((music.ignoreListenerPause, music.ignoreListenerVolume, music.bypassListenerEffects),
                Is.EqualTo((false, false, false)));
            output.enabled = false;
            yield return Frames(5);
            Assert.That(music.isPlaying, Is.True, "a disabled output stops its own source only");
            Assert.That(tone, Is.Not.Null);
            music.Stop();
            output.enabled = true;
            yield return Frames(40);
            Assert.That(music.isPlaying, Is.False);
            Assert.That(output.Level, Is.GreaterThan(Audible));
        }

        [UnityTest]
        public IEnumerator AnOutputSwitchedOnWithItsObjectPlaysFromOneSourceOnly()
        {
            FinishLoading();
            Board();
            Output(out HapticOutput output);
            Circling();
            yield return Frames(10);
            for (int round = 0; round < 5; ++round)
            {
                output.gameObject.SetActive(false);
                yield return Frames(3);
                output.gameObject.SetActive(true);
                yield return Frames(3);
            }
            yield return Frames(40);
            Assert.That(output.transform.childCount, Is.EqualTo(1));
            Assert.That(output.Level, Is.GreaterThan(Audible));
            Transform owner = output.transform;
            UnityEngine.Object.DestroyImmediate(output);
            yield return Frames(50);
            Assert.That(owner.childCount, Is.Zero, "it takes its source along after the fade");
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
    }
}
