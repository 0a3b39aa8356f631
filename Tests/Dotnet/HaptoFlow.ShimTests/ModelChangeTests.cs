using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.ShimTests
{
    /// <summary>The output while the model is changed during a stroke.</summary>
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
