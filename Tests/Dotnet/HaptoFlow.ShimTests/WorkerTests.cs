using System;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.ShimTests
{
    /// <summary>The engine as it ships: a worker of its own, automatic quality, a lead that it finds itself.</summary>
    public sealed class WorkerTests : SceneTest
    {
        private const int MostFrames = 100_000;

        [Test]
        public void TheWorkerOfAShippedEngineGeneratesForATouchingStylus()
        {
            HapticSession.OptionsInstead = null;
            HaptoFlowSettings.Active.Quality = HapticQuality.Auto;
            UnityEngine.Object.DestroyImmediate(Stepper);
            FinishLoading();
            Board();
            AudioTap tap = Output(out _);
            HapticStylus stylus = StylusAlong(seconds =>
                new Vector3(0.05f * (float)Math.Cos(3.0 * seconds), 0.001f, 0.05f * (float)Math.Sin(3.0 * seconds)));
            VoiceStatistics statistics = default;
            // Frames pass faster than their time here, so how many the worker needs is the machine's affair.
            for (int frame = 0; frame < MostFrames && statistics.Inferences < 3; ++frame)
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
    }
}
