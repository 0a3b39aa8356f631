#nullable enable
using System.Collections;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;

namespace HaptoFlow.Tests
{
    /// <summary>The effects of a surface reach the voice, and no other effect runs.</summary>
    public sealed class SurfaceEffectsTests : SceneTest
    {
        [UnityTest]
        public IEnumerator ASurfaceWithoutImpactsPlaysNone()
        {
            FinishLoading();
            HapticSurface board = Board();
            board.Material.Effects = HapticEffects.Texture;
            HapticStylus stylus = StylusAlong(
                seconds => new Vector3(0f, Mathf.Max(0.001f, 0.02f - 0.3f * (float)seconds), 0f));
            yield return Frames(12);
            Assert.That(stylus.IsTouching, Is.True);
            Assert.That(stylus.TryGetEffectStatistics(HapticEffect.Impact, out EffectStatistics impact), Is.True);
            Assert.That(impact.IsAskedFor, Is.False);
            Assert.That(stylus.TryGetEffectStatistics(HapticEffect.Edge, out EffectStatistics edge), Is.True);
            Assert.That(edge.IsAskedFor, Is.False);
            Assert.That(edge.Runs + edge.Prepared + edge.Events, Is.Zero);
        }

        [UnityTest]
        public IEnumerator SlidingOffTheRimOfABoardPlaysOneEdge()
        {
            FinishLoading();
            Board();
            AudioTap tap = Output(out _);
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0.15f + 0.2f * (float)seconds, 0.001f, 0f));
            yield return Frames(40);
            Assert.That(stylus.IsTouching, Is.False);
            Assert.That(stylus.TryGetEffectStatistics(HapticEffect.Edge, out EffectStatistics edge), Is.True);
            Assert.That(edge.Events, Is.EqualTo(1UL));
            Assert.That(edge.Runs, Is.GreaterThan(0UL));
            Assert.That(tap.BrokenSamples, Is.Zero);
        }

        [UnityTest]
        public IEnumerator LiftingPlaysNoEdge()
        {
            FinishLoading();
            Board();
            Output(out _);
            HapticStylus stylus = StylusAlong(seconds =>
                new Vector3(0.1f * (float)seconds, seconds < 0.3 ? 0.001f : 0.001f + 0.5f * (float)(seconds - 0.3), 0f));
            yield return Frames(40);
            Assert.That(stylus.IsTouching, Is.False);
            Assert.That(stylus.TryGetEffectStatistics(HapticEffect.Edge, out EffectStatistics edge), Is.True);
            Assert.That(edge.Events, Is.Zero);
        }

        [UnityTest]
        public IEnumerator SlidingAgainstAWallPlaysALandingWithinTheTouch()
        {
            FinishLoading();
            Board();
            HapticSurface wall = Tagged<BoxCollider>("stone", box =>
            {
                box.size = new Vector3(0.1f, 0.2f, 0.4f);
                box.center = new Vector3(0.1f, 0.1f, 0f);
            });
            wall.Material.Effects = HapticEffects.Impact;
            Output(out _);
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0.01f + 0.2f * (float)seconds, 0.001f, 0f));
            yield return Frames(40);
            Assert.That(stylus.Contact.Surface, Is.SameAs(wall));
            Assert.That(stylus.Contact.TouchCounter, Is.EqualTo(1u));
            Assert.That(stylus.Contact.ApproachSpeedMps, Is.EqualTo(0.2f).Within(0.02f));
            Assert.That(stylus.TryGetEffectStatistics(HapticEffect.Impact, out EffectStatistics impact), Is.True);
            Assert.That(impact.Events, Is.EqualTo(1UL), "the tip entered the board without speed");
        }

        [Test]
        public void AMaterialHasAllEffectsByDefault()
        {
            var description = new MaterialDescription();
            Assert.That(
                description.Effects, Is.EqualTo(HapticEffects.Texture | HapticEffects.Impact | HapticEffects.Edge));
            description.Effects = HapticEffects.Nothing;
            Assert.That(description.Effects, Is.EqualTo(HapticEffects.Nothing));
            description.Effects = HapticEffects.Edge;
            Assert.That(description.Effects, Is.EqualTo(HapticEffects.Edge));
            var copy = new MaterialDescription();
            copy.CopyFrom(description);
            Assert.That(copy.Effects, Is.EqualTo(HapticEffects.Edge));
        }
    }
}
