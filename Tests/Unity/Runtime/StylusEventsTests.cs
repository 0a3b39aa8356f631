#nullable enable
using System.Collections;
using System.Collections.Generic;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;

namespace HaptoFlow.Tests
{
    /// <summary>The UnityEvents are raised together with the C# events.</summary>
    public sealed class StylusEventsTests : SceneTest
    {
        [UnityTest]
        public IEnumerator TheInspectorEventsReportASlideOverTwoSurfacesAndItsEnd()
        {
            HapticSurface left = Board("wood");
            HapticSurface right = Board("fur");
            left.transform.position = new Vector3(-0.2f, 0f, 0f);
            right.transform.position = new Vector3(0.2f, 0f, 0f);
            HapticStylus stylus = StylusAlong(seconds => new Vector3(
                0.4f * (float)seconds - 0.1f, seconds < 0.5 ? 0.0005f : 0.1f, 0f));
            var received = new List<string>();
            int moved = 0;
            stylus.Events.TouchBegan.AddListener(surface => received.Add("began " + surface.name));
            stylus.Events.SurfaceChanged.AddListener(surface => received.Add("changed " + surface.name));
            stylus.Events.TouchEnded.AddListener(surface => received.Add("ended " + surface.name));
            stylus.Events.TouchMoved.AddListener(_ => ++moved);
            var log = new TouchLog(stylus);
            yield return Frames(60);
            Assert.That(received, Is.EqualTo(new[] { "began wood", "changed fur", "ended fur" }));
            Assert.That(moved, Is.EqualTo(log.Moved).And.GreaterThan(20));
        }

        [UnityTest]
        public IEnumerator AHandlerThatDisablesTheStylusReceivesOnlyTheEndOfTheTouch()
        {
            Board();
            HapticStylus stylus = StylusAlong(_ => new Vector3(0f, 0.001f, 0f));
            var received = new List<string>();
            stylus.Events.TouchBegan.AddListener(_ =>
            {
                received.Add("began");
                stylus.enabled = false;
            });
            stylus.Events.TouchMoved.AddListener(_ => received.Add("moved"));
            stylus.Events.TouchEnded.AddListener(_ => received.Add("ended"));
            yield return Frames(5);
            Assert.That(received, Is.EqualTo(new[] { "began", "ended" }));
        }
    }

    /// <summary>Event handlers that disable or destroy objects during a touch.</summary>
    public sealed class StylusHandlerTests : SceneTest
    {
        [UnityTest]
        public IEnumerator AStylusDisabledByItsFirstTouchLeavesNoVoiceOpen()
        {
            FinishLoading();
            Board();
            Output(out _);
            HapticStylus stylus = Pressing();
            stylus.TouchBegan += (HapticStylus sender, in HapticContact _) => sender.enabled = false;
            yield return Frames(2);
            Assert.That(stylus.enabled, Is.False);
            Assert.That(Voices(), Is.Zero);
            Assert.That(stylus.IsTouching, Is.False);
        }

        [UnityTest]
        public IEnumerator AStylusDestroyedByItsFirstTouchLeavesNoVoiceOpen()
        {
            FinishLoading();
            Board();
            Output(out _);
            HapticStylus stylus = Pressing();
            yield return null;
            stylus.TouchMoved += (HapticStylus sender, in HapticContact _) => Object.DestroyImmediate(sender);
            yield return Frames(2);
            Assert.That(Voices(), Is.Zero);
        }

        [UnityTest]
        public IEnumerator AStylusDisabledAndEnabledByAHandlerStartsANewTouch()
        {
            FinishLoading();
            Board();
            Output(out _);
            HapticStylus stylus = Pressing();
            var log = new TouchLog(stylus);
            bool done = false;
            stylus.TouchBegan += (HapticStylus sender, in HapticContact _) =>
            {
                if (!done)
                {
                    done = true;
                    sender.enabled = false;
                    sender.enabled = true;
                }
            };
            yield return Frames(3);
            Assert.That(log.Began, Is.EqualTo(2));
            Assert.That(log.Ended, Is.EqualTo(1));
            Assert.That(Voices(), Is.EqualTo(1u));
        }

        [UnityTest]
        public IEnumerator ASurfaceDestroyedByItsFirstTouchIsNotPublished()
        {
            FinishLoading();
            Board();
            Output(out _);
            HapticStylus stylus = Pressing();
            stylus.TouchBegan += (HapticStylus _, in HapticContact contact) =>
                Object.DestroyImmediate(contact.Surface!.gameObject);
            yield return Frames(2);
            Assert.That(stylus.IsTouching, Is.False);
            stylus.TryGetStatistics(out VoiceStatistics statistics);
            Assert.That(statistics.Updates, Is.GreaterThan(0UL));
            Assert.That(statistics.Onsets, Is.Zero);
        }

        [UnityTest]
        public IEnumerator ATouchBeginsWithTheMaterialThatItsHandlersGaveTheSurface()
        {
            FinishLoading();
            HapticSurface board = Board();
            Output(out _);
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0.1f * (float)seconds, 0.001f, 0f));
            stylus.TouchBegan += (HapticStylus _, in HapticContact _) => board.Material.Label = "nothing known";
            yield return Frames(20);
            Assert.That(stylus.IsTouching, Is.True);
            Assert.That(stylus.TryGetStatistics(out VoiceStatistics statistics), Is.True);
            Assert.That((statistics.Onsets, statistics.Inferences), Is.EqualTo((0UL, 0UL)));
        }

        private static uint Voices() =>
            Haptics.TryGetStatistics(out EngineStatistics engine) ? engine.Voices : uint.MaxValue;

        private HapticStylus Pressing() => StylusAlong(_ => new Vector3(0f, 0.001f, 0f));
    }
}
