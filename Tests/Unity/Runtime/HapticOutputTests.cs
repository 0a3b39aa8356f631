#nullable enable
using System;
using System.Collections;
using System.Text.RegularExpressions;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;
using Object = UnityEngine.Object;

namespace HaptoFlow.Tests
{
    public sealed class HapticOutputTests : SceneTest
    {
        private const float Audible = 0.001f;
        private HapticSurface board = null!;
        private HapticOutput output = null!;
        private AudioTap tap = null!;

        [SetUp]
        public void MakeABoardAndAnOutput()
        {
            FinishLoading();
            board = Board();
            tap = Output(out output);
        }

        [UnityTest]
        public IEnumerator SlidingSoundsRestingAndLiftingAreSilent()
        {
            HapticStylus stylus = StylusAlong(seconds => seconds < 1.0
                ? new Vector3(-0.1f + 0.1f * (float)seconds, 0.001f, 0f)
                : new Vector3(0f, 0.1f, 0f));
            var mover = stylus.GetComponent<PathMover>();
            yield return Until(mover, 0.9);
            Assert.That(tap.Peak(), Is.GreaterThan(Audible));
            yield return Until(mover, 1.2);
            tap.Restart();
            yield return Until(mover, 1.5);
            Assert.That(tap.Blocks, Is.GreaterThan(5));
            Assert.That(tap.Peak(), Is.Zero);
            Assert.That(tap.BrokenSamples, Is.Zero);
            VoiceStatistics statistics = StatisticsOf(stylus);
            Assert.That((statistics.Onsets, statistics.Sanitised), Is.EqualTo((1UL, 0UL)));
            Assert.That(statistics.Inferences, Is.GreaterThan(10UL));
        }

        [UnityTest]
        public IEnumerator WithoutTouchNothingIsInferred()
        {
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0.05f * (float)seconds, 0.05f, 0f));
            yield return Frames(60);
            VoiceStatistics statistics = StatisticsOf(stylus);
            Assert.That(statistics.Updates, Is.GreaterThan(50UL));
            Assert.That(statistics.Inferences, Is.Zero);
            Assert.That(Haptics.TryGetStatistics(out EngineStatistics engine), Is.True);
            Assert.That(engine.Segments, Is.Zero);
        }

        [UnityTest]
        public IEnumerator TwoStylusesShareOneOutput()
        {
            HapticStylus first = Circling();
            HapticStylus second = Circling();
            yield return Frames(60);
            Assert.That(tap.Peak(), Is.GreaterThan(Audible));
            Assert.That(tap.BrokenSamples, Is.Zero);
            ulong rendered = StatisticsOf(first).RenderedFrames;
            Assert.That(rendered, Is.GreaterThan(10000UL));
            Assert.That(StatisticsOf(second).RenderedFrames, Is.EqualTo(rendered));
            Assert.That(output.Level, Is.GreaterThan(0f));
        }

        [UnityTest]
        public IEnumerator OnlyTheStagesThatAnOutputUsesRun()
        {
            output.Processing.Actuator = OutputActuator.VoiceCoil;
            HapticStylus stylus = Circling();
            yield return Frames(45);
            Assert.That(tap.Peak(), Is.GreaterThan(Audible));
            Assert.That(RunsOf(stylus, HapticEffect.Compensation), Is.GreaterThan(10UL));
            Assert.That(RunsOf(stylus, HapticEffect.Delay) + RunsOf(stylus, HapticEffect.ExposureGuard), Is.Zero);
            output.Processing.Actuator = OutputActuator.Uncompensated;
            output.Processing.ExposureGuard = true;
            output.Processing.DelayMilliseconds = 50f;
            output.ApplyProcessing();
            yield return Frames(10);
            ulong compensated = RunsOf(stylus, HapticEffect.Compensation);
            yield return Frames(20);
            Assert.That(RunsOf(stylus, HapticEffect.Compensation), Is.EqualTo(compensated));
            Assert.That(RunsOf(stylus, HapticEffect.Delay), Is.GreaterThan(10UL));
            Assert.That(RunsOf(stylus, HapticEffect.ExposureGuard), Is.GreaterThan(10UL));
            Assert.That(tap.BrokenSamples, Is.Zero);
        }

        [UnityTest]
        public IEnumerator ListenPlaysLouderOnLoudspeakersAndHasNoEffectOnAChannelOfItsOwnOrAnActuator()
        {
            HapticStylus stylus = Circling();
            yield return Frames(45);
            float quiet = tap.Peak();
            Assert.That(RunsOf(stylus, HapticEffect.Listen), Is.Zero);
            output.Processing.Listen = true;
            output.ApplyProcessing();
            yield return Frames(45);
            Assert.That(tap.Peak(), Is.GreaterThan(3f * quiet));
            Assert.That(tap.Peak(), Is.LessThan(1f));
            output.Processing.Actuator = OutputActuator.VoiceCoil;
            output.ApplyProcessing();
            yield return NoRuns(stylus);
            output.Processing.Actuator = OutputActuator.Uncompensated;
            output.Channel = 0;
            yield return NoRuns(stylus);
        }

        /// <summary>Waits for the end of a fade; afterwards Listen may not run.</summary>
        private static IEnumerator NoRuns(HapticStylus stylus)
        {
            yield return Frames(20);
            ulong runs = RunsOf(stylus, HapticEffect.Listen);
            yield return Frames(20);
            Assert.That(RunsOf(stylus, HapticEffect.Listen), Is.EqualTo(runs));
        }

        [UnityTest]
        public IEnumerator AnInvalidProfileIsSkippedWithAnError()
        {
            var asset = new TextAsset("{\"name\": 7}") { name = "Broken" };
            output.Processing.Actuator = OutputActuator.Profile;
            output.Processing.Profile = asset;
            LogAssert.Expect(LogType.Error, new Regex("Output plays uncompensated: Broken is not an actuator profile"));
            HapticStylus stylus = Circling();
            yield return Frames(45);
            Assert.That(tap.Peak(), Is.GreaterThan(Audible));
            Assert.That(RunsOf(stylus, HapticEffect.Compensation), Is.Zero);
            Object.DestroyImmediate(asset);
        }

        private static ulong RunsOf(HapticStylus stylus, HapticEffect effect) => StatisticsOf(stylus, effect).Runs;

        [UnityTest]
        public IEnumerator AMutedOutputIsSilentAndCostsNoInference()
        {
            HapticStylus stylus = Circling();
            yield return Frames(45);
            Assert.That(tap.Peak(), Is.GreaterThan(Audible));
            output.Muted = true;
            yield return Frames(10);
            ulong inferences = StatisticsOf(stylus).Inferences;
            tap.Restart();
            yield return Frames(20);
            Assert.That(tap.Blocks, Is.GreaterThan(0));
            Assert.That(tap.Peak(), Is.Zero);
            Assert.That(StatisticsOf(stylus).Inferences, Is.EqualTo(inferences));
            output.Muted = false;
            yield return Frames(30);
            Assert.That(tap.Peak(), Is.GreaterThan(Audible));
        }

        [UnityTest]
        public IEnumerator PanicSilencesTheOutputUntilTheNextTouchDown()
        {
            HapticStylus stylus = StylusAlong(seconds => new Vector3(
                0.05f * (float)Math.Sin(3.0 * seconds), seconds > 1.0 && seconds < 1.2 ? 0.05f : 0.001f, 0f));
            var mover = stylus.GetComponent<PathMover>();
            yield return Until(mover, 0.5);
            Assert.That(tap.Peak(), Is.GreaterThan(Audible));
            Haptics.Panic();
            yield return Frames(3);
            tap.Restart();
            yield return Until(mover, 0.9);
            Assert.That(tap.Peak(), Is.Zero);
            yield return Until(mover, 1.6);
            Assert.That(tap.Peak(), Is.GreaterThan(Audible));
        }

        [UnityTest]
        public IEnumerator APausedApplicationIsSilentAndSoundsAgainAfterwards()
        {
            Circling();
            yield return null;
            yield return Frames(40);
            output.SendMessage("OnApplicationPause", true);
            yield return Frames(5);
            tap.Restart();
            yield return Frames(20);
            Assert.That(tap.Blocks, Is.GreaterThan(0));
            Assert.That(tap.Peak(), Is.Zero);
            output.SendMessage("OnApplicationPause", false);
            yield return Frames(40);
            Assert.That(tap.Peak(), Is.GreaterThan(Audible));
        }

        [UnityTest]
        public IEnumerator StrengthOfSurfaceStylusAndOutputMultiply()
        {
            HapticStylus stylus = Circling();
            yield return Frames(60);
            Assert.That(tap.Peak(), Is.GreaterThan(Audible));
            board.Material.Strength = 0.5f;
            stylus.Strength = 0f;
            output.Strength = 0.5f;
            yield return Frames(5);
            tap.Restart();
            yield return Frames(30);
            Assert.That(tap.Blocks, Is.GreaterThan(0));
            Assert.That(tap.Peak(), Is.LessThan(1e-6f));
        }
    }

    /// <summary>Interactions of the haptics with the rest of a game's sound.</summary>
    public sealed class ListenerRouteTests : SceneTest
    {
        private const float Audible = 0.001f;

        [SetUp]
        public void MakeABoard()
        {
            FinishLoading();
            Board();
        }

        [UnityTest]
        public IEnumerator AnExclusiveChannelCarriesOnlyTheHaptics()
        {
            AudioTap tap = Ears(out HapticOutput output);
            output.Channel = 1;
            StylusAlong(_ => new Vector3(0f, 0.05f, 0f)).Output = output;
            yield return Frames(20);
            Assert.That(tap.Blocks, Is.GreaterThan(0));
            Assert.That(tap.Peak(0), Is.EqualTo(0.25f).Within(1e-6f));
            Assert.That(tap.Peak(1), Is.Zero);
        }

        [UnityTest]
        public IEnumerator AListenerRouteWithoutAChannelIsSilentAndLogsAnError()
        {
            LogAssert.Expect(LogType.Error, new Regex("Ears is silent: .*Choose a channel"));
            AudioTap tap = Ears(out HapticOutput output);
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
            Output(out HapticOutput output);
            HapticStylus stylus = Circling();
            yield return Frames(40);
            Assert.That(output.Level, Is.GreaterThan(Audible));
            Time.timeScale = 0f;
            AudioListener.pause = true;
            yield return Frames(20);
            VoiceStatistics before = StatisticsOf(stylus);
            Assert.That(before.Silence, Is.EqualTo(HapticSilence.Paused));
            yield return Frames(60);
            Assert.That(output.Level, Is.LessThan(Audible));
            Assert.That(StatisticsOf(stylus).Inferences, Is.EqualTo(before.Inferences), "a pause costs nothing");
            Time.timeScale = 1f;
            AudioListener.pause = false;
            yield return Frames(40);
            Assert.That(output.Level, Is.GreaterThan(Audible));
        }

        [UnityTest]
        public IEnumerator AnOutputThatPlaysWhilePausedGoesOnInAPauseMenu()
        {
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
            Object.DestroyImmediate(output);
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
