#nullable enable
using System.Collections;
using System.Text.RegularExpressions;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;

namespace HaptoFlow.Tests
{
    /// <summary>The output that a stylus plays on when outputs are added, removed and disabled.</summary>
    public sealed class SceneOutputsTests : SceneTest
    {
        private const float Audible = 0.001f;

        [SetUp]
        public void MakeABoard()
        {
            FinishLoading();
            Board();
        }

        [UnityTest]
        public IEnumerator AnAuthorsOutputReplacesTheCreatedOne()
        {
            LogAssert.Expect(LogType.Log, new Regex("the scene has no Haptic Output"));
            HapticStylus stylus = Circling();
            yield return Frames(30);
            Assert.That(Outputs(), Has.Length.EqualTo(1), "one was created");
            AudioTap tap = Output(out HapticOutput authors);
            yield return Frames(40);
            Assert.That(tap.Peak(), Is.GreaterThan(Audible));
            Assert.That(Outputs(), Is.EqualTo(new[] { authors }), "the created one is destroyed");
            Assert.That(stylus.TryGetStatistics(out _), Is.True);
        }

        [UnityTest]
        public IEnumerator ACreatedOutputIsDestroyedWithItsScene()
        {
            Circling();
            yield return Frames(5);
            Assert.That(Outputs(), Has.Length.EqualTo(1));
#if HAPTOFLOW_OUTSIDE_UNITY
            UnityShim.World.LoadEmptyScene();
            Assert.That(Outputs(), Is.Empty);
#endif
        }

        [UnityTest]
        public IEnumerator ADisabledAssignedOutputIsSilentAndNoneIsCreated()
        {
            AudioTap tap = Output(out HapticOutput output);
            HapticStylus stylus = Circling();
            stylus.Output = output;
            yield return Frames(40);
            Assert.That(tap.Peak(), Is.GreaterThan(Audible));
            output.enabled = false;
            yield return Frames(10);
            Assert.That(Outputs(), Is.EqualTo(new[] { output }));
            Assert.That(stylus.TryGetStatistics(out _), Is.False, "a stylus without output has no voice");
            output.enabled = true;
            tap.Restart();
            yield return Frames(40);
            Assert.That(tap.Peak(), Is.GreaterThan(Audible));
        }

        [UnityTest]
        public IEnumerator ADestroyedOutputIsReplacedByACreatedOne()
        {
            Output(out HapticOutput output);
            HapticStylus stylus = Circling();
            stylus.Output = output;
            yield return Frames(5);
            output.enabled = false;
            yield return Frames(2);
            Object.DestroyImmediate(output.gameObject);
            yield return Frames(5);
            Assert.That(Outputs(), Has.Length.EqualTo(1));
            Assert.That(stylus.TryGetStatistics(out _), Is.True);
        }

        [UnityTest]
        public IEnumerator ADisabledOutputOfTheAuthorSilencesTheCreatedOne()
        {
            HapticStylus stylus = Circling();
            yield return Frames(5);
            GameObject owner = Make("Late");
            owner.SetActive(false);
            var late = owner.AddComponent<HapticOutput>();
            late.enabled = false;
            owner.SetActive(true);
            yield return Frames(5);
            Assert.That(Outputs(), Is.EqualTo(new[] { late }));
            Assert.That(stylus.TryGetStatistics(out _), Is.False);
        }

        [UnityTest]
        public IEnumerator AnOutputOnAnInactiveObjectIsSilentUntilItIsActive()
        {
            GameObject owner = Make("Sleeping");
            owner.SetActive(false);
            var output = owner.AddComponent<HapticOutput>();
            HapticStylus stylus = Circling();
            yield return Frames(5);
            Assert.That(Outputs(), Is.EqualTo(new[] { output }));
            Assert.That(stylus.TryGetStatistics(out _), Is.False);
            owner.SetActive(true);
            yield return Frames(5);
            Assert.That(stylus.TryGetStatistics(out _), Is.True);
        }

        private static HapticOutput[] Outputs() => All<HapticOutput>();
    }
}
