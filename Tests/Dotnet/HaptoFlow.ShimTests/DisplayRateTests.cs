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

        [Test]
        public void TheRateOfAHeadsetTakesPrecedenceOverThatOfTheScreen()
        {
            Displays.Screen = new RefreshRate { numerator = 60, denominator = 1 };
            Displays.Wear(120f);
            Assert.That(EngineRateHz(), Is.EqualTo(120.0).Within(1e-3));
        }

        [Test]
        public void TheRateOfTheScreenIsUsedWithoutAHeadsetRate()
        {
            Displays.Screen = new RefreshRate { numerator = 59940, denominator = 1000 };
            Displays.Wear(null);
            Displays.Wear(90f).Stop();
            Assert.That(EngineRateHz(), Is.EqualTo(59.94).Within(1e-3));
        }

        [Test]
        public void TheRateOfTheSettingsIsUsedWithoutADisplayRate()
        {
            HaptoFlowSettings.Active.UpdateRateHz = 80f;
            Assert.That(EngineRateHz(), Is.EqualTo(80.0).Within(1e-3));
        }

        [Test]
        public void TheRateOfTheSettingsIsUsedWhenTheDisplayIsNotFollowed()
        {
            Displays.Wear(120f);
            HaptoFlowSettings.Active.FollowDisplay = false;
            Assert.That(EngineRateHz(), Is.EqualTo(72.0).Within(1e-3));
        }

        [TestCase(0f)]
        [TestCase(-1f)]
        [TestCase(float.NaN)]
        [TestCase(float.PositiveInfinity)]
        [TestCase(1e6f)]
        public void AnImplausibleDisplayRateIsIgnored(float hertz)
        {
            Displays.Wear(hertz);
            Assert.That(EngineRateHz(), Is.EqualTo(72.0).Within(1e-3));
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
