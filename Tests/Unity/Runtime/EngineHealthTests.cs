#nullable enable
using System.Collections;
using System.Linq;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;

namespace HaptoFlow.Tests
{
    /// <summary>Reports about the health of the engine in a running scene.</summary>
    public sealed class EngineHealthTests : SceneTest
    {
        [Test]
        public void AnEndedWorkerIsReportedOnceWithItsFailure()
        {
            var health = new EngineHealth();
            // Empty statistics: the worker is not alive.
            Assert.That(health.MessageFor(default, "the graph of tier draft failed"),
                Does.Contain("(the graph of tier draft failed)").And.Contain("Haptics.Restart"));
            Assert.That(health.MessageFor(default, "again"), Is.Null);
            Assert.That(new EngineHealth().MessageFor(default, ""), Does.Not.Contain("("));
        }

        [UnityTest]
        public IEnumerator TheTierOfANewQualityIsLoadedOnAnotherThread()
        {
            FinishLoading();
            HapticEngine engine = HapticSession.Current.Engine!;
            uint draft = engine.Statistics().Tier;
            Haptics.SetQuality(HapticQuality.Sketch);
            Haptics.SetQuality(HapticQuality.Standard);
            HapticSession.Current.FinishQualityChange();
            engine.Step();
            yield return null;
            int place = HaptoFlowSettings.Active.Model!.Header.Tiers.ToList().FindIndex(tier => tier.Name == "standard");
            Assert.That(engine.Statistics().Tier, Is.Not.EqualTo(draft).And.EqualTo((uint)place));
            Assert.That(HaptoFlowSettings.Active.Quality, Is.EqualTo(HapticQuality.Standard));
        }

        [UnityTest]
        public IEnumerator ShuttingDownDuringLoadingCausesNoError()
        {
            HaptoFlowSettings.Active.Quality = HapticQuality.Standard;
            HapticSession loading = HapticSession.Current;
            HapticSession.ShutDown();
            loading.FinishLoading();
            Assert.That(loading.Engine, Is.Null);
            Assert.That(loading.Problem, Is.Null);
            Assert.That(HapticSession.Existing, Is.Null);
            FinishLoading();
            Assert.That(Haptics.IsReady, Is.True, "the next engine loads");
            Haptics.SetQuality(HapticQuality.Draft);
            Haptics.Restart();
            yield return null;
        }
    }
}
