using System;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

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
            Assert.That(stylus.TryGetStatistics(out VoiceStatistics statistics), Is.True);
            Assert.That((statistics.Failures, tap.BrokenSamples), Is.EqualTo((0UL, 0)));
        }
    }
}
