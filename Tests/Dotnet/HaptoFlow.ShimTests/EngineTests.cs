using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

namespace HaptoFlow.ShimTests
{
    /// <summary>The engine with its default settings: a worker thread, automatic quality, an automatic lead.</summary>
    public sealed class WorkerTests : SceneTest
    {
        private const int MaximumFrames = 100_000;

        [Test]
        public void TheWorkerOfAShippedEngineGeneratesForATouchingStylus()
        {
            HapticSession.OptionsOverride = null;
            HaptoFlowSettings.Active.Quality = HapticQuality.Auto;
            UnityEngine.Object.DestroyImmediate(Stepper);
            FinishLoading();
            Board();
            AudioTap tap = Output(out _);
            HapticStylus stylus = StylusAlong(seconds =>
                new Vector3(0.05f * (float)Math.Cos(3.0 * seconds), 0.001f, 0.05f * (float)Math.Sin(3.0 * seconds)));
            VoiceStatistics statistics = default;
            // Frames run faster than in real time here, so the number that the worker needs depends on the machine.
            for (int frame = 0; frame < MaximumFrames && statistics.Inferences < 3; ++frame)
            {
                World.Frame();
                stylus.TryGetStatistics(out statistics);
            }
            Assert.That(statistics.Inferences, Is.GreaterThanOrEqualTo(3UL));
            Assert.That(statistics.Failures, Is.Zero);
            Assert.That(HapticSession.Current.Engine!.Statistics().WorkerIsAlive, Is.True);
            Assert.That(statistics.Onsets, Is.EqualTo(1UL));
            Assert.That(tap.Peak(), Is.GreaterThan(0.001f));
            Assert.That(tap.BrokenSamples, Is.Zero);
        }

        [Test]
        public void ReplacingAMaterialRepeatedlyWhileAWorkerUsesItIsSafe()
        {
            HapticSession.OptionsOverride = null;
            UnityEngine.Object.DestroyImmediate(Stepper);
            byte[] model = DefaultModel.Asset().File;
            string[] texts = Array.ConvertAll(new[] { "glass", "corduroy", "carpet" },
                label => Model.MaterialText.OfLabel(model, label));
            HapticMaterial material = HapticMaterial.Create(texts[0], "fur");
            Board().SharedMaterial = material;
            FinishLoading();
            AudioTap tap = Output(out _);
            HapticStylus stylus = Circling();
            for (int round = 0; round < 150; ++round)
            {
                material.Carry(texts[round % texts.Length]);
                World.Frames(3);
            }
            HapticSession.Current.FinishRegistrations();
            Assert.That((Haptics.LearntMaterials, Haptics.RefusedMaterials), Is.EqualTo((1, 0)));
            Assert.That((StatisticsOf(stylus).Failures, tap.BrokenSamples), Is.EqualTo((0UL, 0)));
        }
    }

    /// <summary>A refusal lasts as long as its reason, and is said once.</summary>
    public sealed class RefusalTests : SceneTest
    {
        [Test]
        public void TheSixtyFifthStylusGetsItsVoiceWhenAnotherOneEnds()
        {
            List<HapticStylus> styluses = Play(65, 60);
            HapticStylus refused = styluses.Single(each => !each.TryGetStatistics(out _));
            Assert.That(Log.Count("gets no voice"), Is.EqualTo(1), "once, not each time that it asks");
            Object.DestroyImmediate(styluses.First(each => each != refused).gameObject);
            World.Frames(60);
            Assert.That(refused.TryGetStatistics(out _), Is.True);
            Assert.That(Log.Count("has got its voice"), Is.EqualTo(1));
        }

        [Test]
        public void AStylusThatIsEnabledAgainAsksAtOnce()
        {
            List<HapticStylus> styluses = Play(65, 3);
            HapticStylus refused = styluses.Single(each => !each.TryGetStatistics(out _));
            styluses.First(each => each != refused).enabled = false;
            refused.enabled = false;
            refused.enabled = true;
            World.Frame();
            Assert.That(refused.TryGetStatistics(out _), Is.True);
        }

        [Test]
        public void AFadingVoiceDoesNotKeepItsPlaceFromAnother()
        {
            List<HapticStylus> styluses = Play(64, 30);
            styluses.ForEach(each => each.enabled = false);
            styluses.ForEach(each => each.enabled = true);
            World.Frames(1);
            Assert.That(styluses.Count(each => each.TryGetStatistics(out _)), Is.EqualTo(64));
            Assert.That(Log.Count("gets no voice"), Is.Zero);
        }

        [Test]
        public void ADeviceOfAnotherRateIsServedAtOnceAfterOneThatCouldNotBe()
        {
            FinishLoading();
            Board();
            AudioDevice.ChangeDevice(384000, 1024, AudioSpeakerMode.Stereo);
            HapticStylus stylus = Circling();
            World.Frames(60);
            Assert.That(stylus.TryGetStatistics(out _), Is.False);
            Assert.That(Log.Count("gets no voice"), Is.EqualTo(1));
            AudioDevice.ChangeDevice(48000, 512, AudioSpeakerMode.Stereo);
            World.Frames(2);
            Assert.That(stylus.TryGetStatistics(out _), Is.True);
        }

        [TestCase(false, "no model is chosen: choose one in Project Settings")]
        [TestCase(true, "checksum")]
        public void AModelThatWasMissingOrDamagedIsNamedOnceAndLoadedWhenAnotherIsThere(bool isDamaged, string why)
        {
            HaptoFlowSettings settings = HaptoFlowSettings.Active;
            HapticModelAsset? whole = settings.Model;
            settings.Model = isDamaged ? EditedModel.Damaged() : null;
            FinishLoading();
            Board();
            Output(out _);
            HapticStylus stylus = Circling();
            World.Frames(20);
            Assert.That((stylus.IsTouching, stylus.TryGetStatistics(out _), Haptics.IsReady), Is.EqualTo((true, false, false)));
            Assert.That(Haptics.Problem, Does.Contain(why));
            Assert.That(Log.Count("the scene runs without haptics"), Is.EqualTo(1));
            settings.Model = whole;
            World.Frame();
            FinishLoading();
            World.Frames(20);
            Assert.That(stylus.TryGetStatistics(out _), Is.True);
            Assert.That(Log.Count("the scene runs without haptics"), Is.EqualTo(1));
        }

        private List<HapticStylus> Play(int styluses, int frames)
        {
            FinishLoading();
            Board();
            Output(out _);
            List<HapticStylus> made = Enumerable.Range(0, styluses).Select(_ => Circling()).ToList();
            World.Frames(frames);
            return made;
        }
    }

    public sealed class ModelChangeTests : SceneTest
    {
        private const int RateHz = 48000;

        [Test]
        public void ChangingTheModelDuringAStrokeCausesNoClickAndNoGap()
        {
            FinishLoading();
            using HapticLoadedModel first = Loaded(DefaultModel.Asset());
            using HapticLoadedModel second = Loaded(EditedModel.WithLabelsReversed());
            Board();
            Output(out _);
            HapticStylus stylus = Circling();
            World.Frames(30);
            AudioDevice.Forget();
            var changes = new List<int>();
            for (int round = 0; round < 12; ++round)
            {
                World.Frames(45);
                changes.Add(AudioDevice.RecordedFrames);
                (round % 2 == 0 ? second : first).Use();
            }
            World.Frames(45);
            float steady = Enumerable.Range(1, AudioDevice.RecordedFrames - 1)
                .Where(frame => changes.All(change => Math.Abs(frame - change) > 0.1 * RateHz)).Max(Jump);
            foreach (int change in changes)
            {
                float jump = Enumerable.Range(change, (int)(0.08 * RateHz)).Max(Jump);
                // While one voice fades into the other, both have the noise of one place and add up in phase.
                Assert.That(jump, Is.LessThan(2f * steady), $"a click after frame {change}");
            }
            double loudness = Rms(0, changes[0]);
            foreach (int change in changes)
            {
                for (int start = change; start < change + (int)(0.08 * RateHz); start += RateHz / 50)
                {
                    Assert.That(Rms(start, RateHz / 50), Is.GreaterThan(0.1 * loudness), $"a gap at frame {start}");
                }
            }
            Assert.That(stylus.IsTouching, Is.True);
        }

        [Test]
        public void TheVoiceOfThePreviousModelIsClosedAfterItsFade()
        {
            FinishLoading();
            using HapticLoadedModel second = Loaded(EditedModel.WithLabelsReversed());
            HapticEngine before = HapticSession.Current.Engine!;
            Board();
            Output(out HapticOutput output);
            Circling();
            World.Frames(30);
            output.GetComponentInChildren<AudioSource>(true).Stop();
            second.Use();
            World.Frames(20);
            Assert.That(before.Statistics().Voices, Is.Zero);
        }

        private static HapticLoadedModel Loaded(HapticModelAsset asset)
        {
            HapticLoadedModel model = Haptics.Load(asset, HapticQuality.Draft);
            model.FinishLoading();
            return model;
        }

        private static float Jump(int frame) =>
            Math.Abs(AudioDevice.Sample(frame, 0) - AudioDevice.Sample(frame - 1, 0));

        private static double Rms(int start, int frames) => Math.Sqrt(Enumerable.Range(start, frames)
            .Average(frame => AudioDevice.Sample(frame, 0) * (double)AudioDevice.Sample(frame, 0)));
    }
}
