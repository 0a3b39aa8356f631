#nullable enable
using System;
using System.Collections;
using System.Linq;
using System.Text.RegularExpressions;
using System.Threading.Tasks;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;

namespace HaptoFlow.Tests
{
    public sealed class SessionTests : SceneTest
    {
        [UnityTest]
        public IEnumerator AnUnknownLabelIsNotFeltAndWarnsOnceWithSimilarNames()
        {
            FinishLoading();
            using var log = new LogRecord();
            LogAssert.Expect(LogType.Warning, new Regex("no label \"woodd\".*near matches: wood"));
            Board("woodd");
            AudioTap tap = Output(out _);
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0.05f * (float)seconds, 0.001f, 0f));
            yield return Frames(30);
            Assert.That(stylus.IsTouching, Is.True);
            Assert.That(tap.Peak(), Is.Zero);
            Assert.That(log.Lines.Count(line => line.Type == LogType.Warning), Is.EqualTo(1));
        }

        [Test]
        public void TwoLabelsAreBlendedByWeight()
        {
            FinishLoading();
            HapticSurface board = Board("wood");
            board.Material.SecondLabel = "fur";
            board.Material.Blend = 0.25f;
            LabelBlend blend = board.LookUp(HapticSession.Current).Labels;
            Assert.That((blend.Count, blend.Weight(0), blend.Weight(1)), Is.EqualTo((2, 0.75f, 0.25f)));
            board.Material.Blend = 0f;
            Assert.That(board.LookUp(HapticSession.Current).Labels.Count, Is.EqualTo(1));
        }

        [UnityTest]
        public IEnumerator TheStylusUsesARestartedEngine()
        {
            FinishLoading();
            Board();
            AudioTap tap = Output(out HapticOutput output);
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0.05f * (float)seconds, 0.001f, 0f));
            yield return Frames(20);
            Haptics.Restart();
            Assert.That(Haptics.IsReady, Is.False);
            Assert.That(stylus.TryGetStatistics(out _), Is.False);
            stylus.Panic();
            output.Muted = true;
            output.Muted = false;
            yield return null;
            Assert.That(stylus.TryGetStatistics(out _), Is.False);
            FinishLoading();
            tap.Restart();
            yield return Frames(30);
            Assert.That(StatisticsOf(stylus).Inferences, Is.GreaterThan(0UL));
            Assert.That(tap.Peak(), Is.GreaterThan(0.001f));
        }
    }

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
        public IEnumerator TheLastOfSeveralQualitiesIsPlayedFromTheNextSegmentOn()
        {
            FinishLoading();
            HapticEngine engine = HapticSession.Current.Engine!;
            uint draft = engine.Statistics().Tier;
            Haptics.SetQuality(HapticQuality.Sketch);
            Haptics.SetQuality(HapticQuality.Standard);
            engine.Step();
            yield return null;
            int place = HaptoFlowSettings.Active.Model!.Header.Tiers.ToList().FindIndex(tier => tier.Name == "standard");
            Assert.That(engine.Statistics().Tier, Is.Not.EqualTo(draft).And.EqualTo((uint)place));
            Assert.That(HaptoFlowSettings.Active.Quality, Is.EqualTo(HapticQuality.Standard));
            Assert.That(Haptics.LastFailure, Is.Empty);
        }

        [Test]
        public void ShuttingDownDuringLoadingCausesNoError()
        {
            HaptoFlowSettings.Active.Quality = HapticQuality.Standard;
            HapticSession loading = HapticSession.Current;
            Assert.That((Haptics.LearntMaterials, Haptics.RefusedMaterials), Is.EqualTo((0, 0)));
            HapticSession.ShutDown();
            loading.FinishLoading();
            Assert.That(loading.Engine, Is.Null);
            Assert.That(loading.Problem, Is.Null);
            Assert.That((HapticSession.Existing, Haptics.LearntMaterials), Is.EqualTo(((HapticSession?)null, 0)));
            FinishLoading();
            Assert.That(Haptics.IsReady, Is.True, "the next engine loads");
            Haptics.SetQuality(HapticQuality.Draft);
            Haptics.Restart();
        }
    }

    /// <summary>Models that are loaded in addition to the one in use, and replace it.</summary>
    public sealed class LoadedModelTests : SceneTest
    {
        private const int RateHz = 48000;
        private const int BlockFrames = 512;

        private HapticLoadedModel other = null!;

        [SetUp]
        public void LoadBeside()
        {
            FinishLoading();
            other = Haptics.Load(EditedModel.WithLabelsReversed(), HapticQuality.Standard);
        }

        [UnityTest]
        public IEnumerator TheModelInUseGeneratesAndThePreviousOneRests()
        {
            other.FinishLoading();
            Assert.That((other.IsReady, other.IsInUse, other.Problem), Is.EqualTo((true, false, (string?)null)));
            Assert.That(other.Labels, Is.EqualTo(Haptics.Labels));
            Assert.That(other.TierName, Is.EqualTo("standard"));
            HapticEngine before = HapticSession.Current.Engine!;
            Board();
            AudioTap tap = Output(out _);
            HapticStylus stylus = Circling();
            yield return Frames(20);
            other.Use();
            Assert.That(other.IsInUse, Is.True);
            yield return Frames(10);
            ulong restedSegments = before.Statistics().Segments;
            tap.Restart();
            yield return Frames(30);
            Assert.That(HapticSession.Current.Engine!.Statistics().Segments, Is.GreaterThan(0UL));
            Assert.That(before.Statistics().Segments, Is.EqualTo(restedSegments));
            Assert.That(before.Statistics().Voices, Is.Zero);
            Assert.That(StatisticsOf(stylus).Inferences, Is.GreaterThan(0UL));
            Assert.That(tap.Peak(), Is.GreaterThan(0.001f));
            Haptics.UseSettings();
            Assert.That(HapticSession.Current.Engine, Is.SameAs(before));
        }

        [Test]
        public void AModelThatCannotBeLoadedReportsWhyAndTheSceneKeepsItsHaptics()
        {
            using HapticLoadedModel damaged = Haptics.Load(EditedModel.Damaged(), HapticQuality.Draft);
            damaged.FinishLoading();
            Assert.That(damaged.IsReady, Is.False);
            Assert.That(damaged.Problem, Does.Contain("checksum"));
            Assert.That(damaged.Use, Throws.InvalidOperationException.With.Message.Contains("checksum"));
            Assert.That(() => damaged.MeasureDelay(RateHz, BlockFrames), Throws.InvalidOperationException);
            Assert.That((Haptics.IsReady, Haptics.Problem), Is.EqualTo((true, (string?)null)));
        }

        [UnityTest]
        public IEnumerator AfterDisposingTheModelInUseTheSettingsModelIsUsed()
        {
            other.FinishLoading();
            Board();
            AudioTap tap = Output(out _);
            HapticStylus stylus = Circling();
            other.Use();
            yield return Frames(20);
            other.Dispose();
            other.Dispose();
            Assert.That((other.IsInUse, other.IsReady), Is.EqualTo((false, false)));
            Assert.That(other.Problem, Is.EqualTo("the model was closed"));
            yield return Frames(5);
            tap.Restart();
            yield return Frames(20);
            Assert.That(StatisticsOf(stylus).Inferences, Is.GreaterThan(0UL));
            Assert.That(tap.Peak(), Is.GreaterThan(0.001f));
        }

        [Test]
        public void ARestartUsesTheSettingsModelAndKeepsLoadedModels()
        {
            other.FinishLoading();
            other.Use();
            Haptics.Restart();
            Assert.That(other.IsInUse, Is.False);
            Assert.That(Haptics.IsReady, Is.False);
            FinishLoading();
            Assert.That(other.IsReady, Is.True);
            other.Use();
            Assert.That(other.IsInUse, Is.True);
        }

        [Test]
        public void LoadedModelsAreClosedWhenTheApplicationEnds()
        {
            HapticSession.ShutDown();
            Assert.That(other.Problem, Is.EqualTo("the model was closed"));
            Assert.That(other.Use, Throws.InvalidOperationException);
            other.Dispose();
        }

        [Test]
        public void TheDelayOfAModelIsMeasuredWithoutAPen()
        {
            other.FinishLoading();
            Task<HapticModelDelay> measuring = other.MeasureDelay(RateHz, BlockFrames);
            Assert.That(other.MeasureDelay(RateHz, BlockFrames), Is.SameAs(measuring));
            HapticModelDelay delay = measuring.GetAwaiter().GetResult();
            Assert.That(delay.Runs, Is.GreaterThanOrEqualTo(100UL));
            Assert.That(delay.LeadMilliseconds, Is.GreaterThan(0.0));
            Assert.That(delay.InferenceMedianMilliseconds, Is.GreaterThan(0.0));
            Assert.That(delay.InferencePercentile99Milliseconds,
                Is.GreaterThanOrEqualTo(delay.InferenceMedianMilliseconds));
        }

        [Test]
        public void ClosingAModelEndsItsMeasurement()
        {
            other.FinishLoading();
            Task<HapticModelDelay> measuring = other.MeasureDelay(RateHz, BlockFrames);
            other.Dispose();
            Assert.That(measuring.IsCompleted, Is.True);
        }

        [Test]
        public void AModelIsLoadedFromAnAsset() =>
            Assert.That(() => Haptics.Load(null!, HapticQuality.Draft), Throws.ArgumentNullException);
    }
}
