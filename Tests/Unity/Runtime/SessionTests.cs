#nullable enable
using System;
using System.Collections;
using System.Text.RegularExpressions;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;

namespace HaptoFlow.Tests
{
    public sealed class SessionTests : SceneTest
    {
        [UnityTest]
        public IEnumerator WithoutAModelTheSceneRunsOnAndLogsOneError()
        {
            LogAssert.Expect(LogType.Error, new Regex("runs without haptics: no model is chosen.*Project Settings"));
            HaptoFlowSettings.Active.Model = null;
            yield return TouchTwice();
            Assert.That(Haptics.IsReady, Is.False);
            Assert.That(Haptics.Problem, Does.Contain("no model"));
        }

        [UnityTest]
        public IEnumerator ADamagedModelLogsOneErrorAndTheSceneRunsOn()
        {
            LogAssert.Expect(LogType.Error, new Regex("runs without haptics: .*checksum"));
            byte[] damaged = (byte[])DefaultModel.Asset().File.Clone();
            damaged[100] ^= 1;
            HaptoFlowSettings.Active.Model = HapticModelAsset.Create(damaged);
            yield return TouchTwice();
            Assert.That(Haptics.IsReady, Is.False);
        }

        [UnityTest]
        public IEnumerator AnUnknownLabelIsNotFeltAndWarnsOnceWithSimilarNames()
        {
            FinishLoading();
            using var warnings = new WarningCount();
            LogAssert.Expect(LogType.Warning, new Regex("no label \"woodd\".*near matches: wood"));
            Board("woodd");
            AudioTap tap = Output(out _);
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0.05f * (float)seconds, 0.001f, 0f));
            for (int frame = 0; frame < 30; ++frame)
            {
                yield return null;
            }
            Assert.That(stylus.IsTouching, Is.True);
            Assert.That(tap.Peak(), Is.Zero);
            Assert.That(warnings.Value, Is.EqualTo(1));
        }

        [UnityTest]
        public IEnumerator TwoLabelsAreBlendedByWeight()
        {
            FinishLoading();
            HapticSurface board = Board("wood");
            board.Material.SecondLabel = "fur";
            board.Material.Blend = 0.25f;
            LabelBlend blend = board.BlendFor(HapticSession.Current);
            Assert.That(blend.Count, Is.EqualTo(2));
            Assert.That(blend.Weight(0), Is.EqualTo(0.75f));
            Assert.That(blend.Weight(1), Is.EqualTo(0.25f));
            board.Material.Blend = 0f;
            Assert.That(board.BlendFor(HapticSession.Current).Count, Is.EqualTo(1));
            yield return null;
        }

        [UnityTest]
        public IEnumerator SurfacesThatShareAMaterialChangeTogether()
        {
            FinishLoading();
            var shared = ScriptableObject.CreateInstance<HapticMaterial>();
            shared.Description.Label = "glass";
            HapticSurface first = Board("wood");
            HapticSurface second = Board("fur");
            first.SharedMaterial = shared;
            second.SharedMaterial = shared;
            LabelBlend glass = first.BlendFor(HapticSession.Current);
            Assert.That(second.BlendFor(HapticSession.Current), Is.EqualTo(glass));
            shared.Description.Label = "rubber";
            Assert.That(second.BlendFor(HapticSession.Current), Is.Not.EqualTo(glass));
            Assert.That(second.BlendFor(HapticSession.Current), Is.EqualTo(first.BlendFor(HapticSession.Current)));
            yield return null;
        }

        [UnityTest]
        public IEnumerator TheStylusUsesARestartedEngine()
        {
            FinishLoading();
            Board();
            AudioTap tap = Output(out HapticOutput output);
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0.05f * (float)seconds, 0.001f, 0f));
            for (int frame = 0; frame < 20; ++frame)
            {
                yield return null;
            }
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
            for (int frame = 0; frame < 30; ++frame)
            {
                yield return null;
            }
            Assert.That(stylus.TryGetStatistics(out VoiceStatistics statistics), Is.True);
            Assert.That(statistics.Inferences, Is.GreaterThan(0UL));
            Assert.That(tap.Peak(), Is.GreaterThan(0.001f));
        }

        [UnityTest]
        public IEnumerator QualityCanBeChangedDuringATouch()
        {
            FinishLoading();
            Haptics.SetQuality(HapticQuality.Standard);
            Assert.That(HaptoFlowSettings.Active.Quality, Is.EqualTo(HapticQuality.Standard));
            Assert.That(Haptics.Labels, Does.Contain("wood"));
            yield return null;
        }

        /// <summary>Touches, lifts and touches again: an error must be logged only once.</summary>
        private IEnumerator TouchTwice()
        {
            Board();
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0f, seconds > 0.1 && seconds < 0.2 ? 0.1f : 0.001f, 0f));
            var log = new TouchLog(stylus);
            FinishLoading();
            for (int frame = 0; frame < 40; ++frame)
            {
                yield return null;
            }
            Assert.That(log.Began, Is.EqualTo(2));
        }

        /// <summary>Counts the warnings that are logged during its lifetime.</summary>
        private sealed class WarningCount : IDisposable
        {
            public WarningCount() => Application.logMessageReceived += Receive;

            public int Value { get; private set; }

            public void Dispose() => Application.logMessageReceived -= Receive;

            private void Receive(string condition, string stackTrace, LogType type) =>
                Value += type == LogType.Warning ? 1 : 0;
        }
    }
}
