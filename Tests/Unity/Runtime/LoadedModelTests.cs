#nullable enable
using System;
using System.Collections;
using System.Text.RegularExpressions;
using System.Threading.Tasks;
using HaptoFlow.Model;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;
using Object = UnityEngine.Object;

namespace HaptoFlow.Tests
{
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
            Assert.That(stylus.TryGetStatistics(out VoiceStatistics voice), Is.True);
            Assert.That(voice.Inferences, Is.GreaterThan(0UL));
            Assert.That(tap.Peak(), Is.GreaterThan(0.001f));
            Haptics.UseSettings();
            Assert.That(HapticSession.Current.Engine, Is.SameAs(before));
        }

        [UnityTest]
        public IEnumerator AModelThatCannotBeLoadedReportsWhyAndTheSceneKeepsItsHaptics()
        {
            using HapticLoadedModel damaged = Haptics.Load(EditedModel.Damaged(), HapticQuality.Draft);
            damaged.FinishLoading();
            Assert.That(damaged.IsReady, Is.False);
            Assert.That(damaged.Problem, Does.Contain("checksum"));
            Assert.That(damaged.Use, Throws.InvalidOperationException.With.Message.Contains("checksum"));
            Assert.That(() => damaged.MeasureDelay(RateHz, BlockFrames), Throws.InvalidOperationException);
            Assert.That((Haptics.IsReady, Haptics.Problem), Is.EqualTo((true, (string?)null)));
            yield return null;
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
            Assert.That(stylus.TryGetStatistics(out VoiceStatistics voice), Is.True);
            Assert.That(voice.Inferences, Is.GreaterThan(0UL));
            Assert.That(tap.Peak(), Is.GreaterThan(0.001f));
        }

        [UnityTest]
        public IEnumerator ARestartUsesTheSettingsModelAndKeepsLoadedModels()
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
            yield return null;
        }

        [UnityTest]
        public IEnumerator LoadedModelsAreClosedWhenTheApplicationEnds()
        {
            HapticSession.ShutDown();
            Assert.That(other.Problem, Is.EqualTo("the model was closed"));
            Assert.That(other.Use, Throws.InvalidOperationException);
            other.Dispose();
            yield return null;
        }

        [UnityTest]
        public IEnumerator ALearntMaterialIsRegisteredByModelsOfItsSpaceAndRefusedByOthers()
        {
            LogAssert.Expect(LogType.Warning, new Regex("felt as its label \"fur\": .*learnt for another model"));
            using HapticLoadedModel foreign = Haptics.Load(EditedModel.OfAnotherSpace(), HapticQuality.Draft);
            HapticMaterial denim =
                HapticMaterial.Create(MaterialText.OfLabel(DefaultModel.Asset().File, "glass"), "fur");
            other.FinishLoading();
            foreign.FinishLoading();
            yield return UntilKnown(other, denim);
            Assert.That(other.TryPrepare(denim, out string? refusal), Is.True);
            Assert.That(refusal, Is.Null);
            yield return UntilKnown(foreign, denim);
            Assert.That(foreign.TryPrepare(denim, out refusal), Is.False);
            Assert.That(refusal, Does.Contain("another model"));
            Object.DestroyImmediate(denim);
        }

        [UnityTest]
        public IEnumerator TheDelayOfAModelIsMeasuredWithoutAPen()
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
            yield return null;
        }

        [UnityTest]
        public IEnumerator ClosingAModelEndsItsMeasurement()
        {
            other.FinishLoading();
            Task<HapticModelDelay> measuring = other.MeasureDelay(RateHz, BlockFrames);
            other.Dispose();
            Assert.That(measuring.IsCompleted, Is.True);
            yield return null;
        }

        [Test]
        public void AModelIsLoadedFromAnAsset() =>
            Assert.That(() => Haptics.Load(null!, HapticQuality.Draft), Throws.ArgumentNullException);

        private static IEnumerator UntilKnown(HapticLoadedModel model, HapticMaterial material)
        {
            double until = Time.realtimeSinceStartupAsDouble + 60.0;
            while (!model.TryPrepare(material, out string? refusal) && refusal == null &&
                Time.realtimeSinceStartupAsDouble < until)
            {
                yield return null;
            }
        }
    }
}
