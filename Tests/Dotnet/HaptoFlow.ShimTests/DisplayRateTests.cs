using System;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.XR;
using UnityShim;

namespace HaptoFlow.ShimTests
{
    /// <summary>The engine's update rate, which follows the display.</summary>
    public sealed class DisplayRateTests : SceneTest
    {
        [SetUp]
        [TearDown]
        public void RemoveTheHeadset() => Displays.Reset();

        [TestCase(60u, 1u, new[] { 120f }, true, 120.0, TestName = "a headset before the screen")]
        [TestCase(59940u, 1000u, new[] { float.NaN }, true, 59.94, TestName = "the screen beside a headset without a rate")]
        [TestCase(0u, 1u, new float[0], true, 80.0, TestName = "the settings without a display's rate")]
        [TestCase(0u, 1u, new[] { 120f }, false, 80.0, TestName = "the settings where the display is not followed")]
        [TestCase(0u, 1u, new[] { 0f, -1f, float.PositiveInfinity, 1e6f }, true, 80.0, TestName = "no implausible rate")]
        public void TheEngineRunsAtTheRateOf(uint screen, uint share, float[] headsets, bool follows, double expectedHz)
        {
            Displays.Screen = new RefreshRate { numerator = screen, denominator = share };
            Array.ForEach(headsets, hertz => Displays.Wear(float.IsNaN(hertz) ? (float?)null : hertz));
            Displays.Wear(90f).Stop();
            (HaptoFlowSettings.Active.UpdateRateHz, HaptoFlowSettings.Active.FollowDisplay) = (80f, follows);
            Assert.That(EngineRateHz(), Is.EqualTo(expectedHz).Within(1e-3));
        }

        private static double EngineRateHz()
        {
            FinishLoading();
            Assert.That(Haptics.Problem, Is.Null);
            Haptics.TryGetStatistics(out EngineStatistics engine);
            return 1000.0 * HaptoFlowSettings.Active.BudgetShare / engine.BudgetMs;
        }
    }
}
