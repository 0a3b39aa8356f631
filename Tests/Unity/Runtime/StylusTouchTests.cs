#nullable enable
using System;
using System.Collections;
using System.Collections.Generic;
using System.Linq;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;
using Object = UnityEngine.Object;

namespace HaptoFlow.Tests
{
    public sealed class StylusTouchTests : SceneTest
    {
        // At this height the tip of 2 mm radius cuts 1 mm into the board.
        private const float Pressed = 0.001f;
        private const float Lifted = 0.05f;

        [UnityTest]
        public IEnumerator ATouchBeginsMovesAndEndsOnce()
        {
            HapticSurface board = Board();
            HapticStylus stylus = StylusAlong(seconds =>
                new Vector3(0.05f * (float)seconds, seconds > 0.2 && seconds < 0.6 ? Pressed : Lifted, 0f));
            var log = new TouchLog(stylus);
            var mover = stylus.GetComponent<PathMover>();
            yield return Until(mover, 0.5);
            Assert.That((log.Began, log.Ended, stylus.IsTouching), Is.EqualTo((1, 0, true)));
            Assert.That(log.Last.Surface, Is.SameAs(board));
            yield return Until(mover, 0.8);
            Assert.That((log.Began, log.Ended, stylus.IsTouching), Is.EqualTo((1, 1, false)));
            Assert.That(log.Moved, Is.GreaterThan(5));
        }

        [UnityTest]
        public IEnumerator ForceIsStiffnessTimesPenetrationAndVelocityLiesAlongTheGrain()
        {
            HapticSurface board = Board();
            board.Material.StiffnessNewtonsPerMetre = 400f;
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0.06f * (float)seconds, Pressed, -0.02f * (float)seconds));
            yield return Frames(30);
            HapticContact contact = stylus.Contact;
            Assert.That(contact.PenetrationMetres, Is.EqualTo(0.001f).Within(1e-6f));
            Assert.That(contact.ForceNewtons, Is.EqualTo(0.4f).Within(1e-3f));
            Assert.That(contact.FirstVelocityMps, Is.EqualTo(0.06f).Within(6e-4f));
            Assert.That(contact.SecondVelocityMps, Is.EqualTo(0.02f).Within(6e-4f));
            Assert.That(Vector3.Distance(contact.Normal, Vector3.up), Is.LessThan(1e-5f));
            Assert.That(Vector3.Distance(contact.TangentialVelocity, new Vector3(0.06f, 0f, -0.02f)), Is.LessThan(1e-3f));
        }

        [UnityTest]
        public IEnumerator TheAxesTurnWithTheObject()
        {
            HapticSurface board = Board();
            board.transform.rotation = Quaternion.AngleAxis(90f, Vector3.up);
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0f, 0.001f, -0.05f * (float)seconds));
            yield return Frames(30);
            Assert.That(stylus.Contact.FirstVelocityMps, Is.EqualTo(0.05f).Within(1e-3f));
            Assert.That(stylus.Contact.SecondVelocityMps, Is.EqualTo(0f).Within(1e-3f));
        }

        [UnityTest]
        public IEnumerator StiffnessComesFromTheLabelWhereTheSurfaceHasNone()
        {
            FinishLoading();
            HapticSurface board = Board("wood");
            HapticStylus stylus = Resting();
            yield return Frames(2);
            double ofWood = StiffnessOf("wood");
            Assert.That(stylus.Contact.ForceNewtons, Is.EqualTo(Math.Min(5.0, 0.001 * ofWood)).Within(1e-3));
            board.Material.Label = "fur";
            yield return null;
            Assert.That(StiffnessOf("fur"), Is.Not.EqualTo(ofWood));
            Assert.That(stylus.Contact.ForceNewtons, Is.EqualTo(Math.Min(5.0, 0.001 * StiffnessOf("fur"))).Within(1e-3));
        }

        [UnityTest]
        public IEnumerator TheDeepestSurfaceIsTouchedAndKeptByAMargin()
        {
            HapticSurface low = Board("wood");
            HapticSurface high = Board("fur");
            high.transform.position = new Vector3(0f, 0.0003f, 0f);
            HapticStylus stylus = Resting();
            yield return Frames(2);
            Assert.That(stylus.Contact.Surface, Is.SameAs(high));
            low.transform.position = new Vector3(0f, 0.0006f, 0f);
            yield return null;
            Assert.That(stylus.Contact.Surface, Is.SameAs(high));
            low.transform.position = new Vector3(0f, 0.0012f, 0f);
            yield return null;
            Assert.That(stylus.Contact.Surface, Is.SameAs(low));
        }

        [UnityTest]
        public IEnumerator ATeleportGivesNoVelocity()
        {
            Board();
            HapticStylus stylus = StylusAlong(seconds =>
                new Vector3((seconds > 0.3 ? 0.15f : -0.15f) + 0.02f * (float)seconds, Pressed, 0f));
            float fastest = 0f;
            for (int frame = 0; frame < 60; ++frame)
            {
                yield return null;
                fastest = Mathf.Max(fastest, Mathf.Abs(stylus.Contact.FirstVelocityMps));
            }
            Assert.That(fastest, Is.LessThan(0.05f));
            Assert.That(stylus.ContactStatistics.Teleports, Is.EqualTo(1UL));
        }

        [UnityTest]
        public IEnumerator ASurfaceSwitchedOffOrDestroyedUnderTheTipEndsTheTouch()
        {
            HapticSurface board = Board();
            HapticStylus stylus = Resting();
            var log = new TouchLog(stylus);
            yield return Frames(2);
            Assert.That(log.Began, Is.EqualTo(1));
            board.enabled = false;
            yield return null;
            Assert.That(log.Ended, Is.EqualTo(1));
            board.enabled = true;
            yield return null;
            Assert.That(log.Began, Is.EqualTo(2));
            UnityEngine.Object.Destroy(board.gameObject);
            yield return Frames(2);
            Assert.That(log.Ended, Is.EqualTo(2));
        }

        [UnityTest]
        public IEnumerator LayersOutsideTheMaskAreNotFelt()
        {
            HapticSurface board = Board();
            board.gameObject.layer = 8;
            HapticStylus stylus = Resting();
            stylus.Layers = ~(1 << 8);
            yield return Frames(2);
            Assert.That(stylus.IsTouching, Is.False);
            stylus.Layers = 1 << 8;
            yield return null;
            Assert.That(stylus.IsTouching, Is.True);
        }

        private static double StiffnessOf(string label) => HaptoFlowSettings.Active.Model!.Header.Labels
            .Single(each => each.Name == label).StiffnessNewtonsPerMetre;
    }

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
            HapticStylus stylus = Resting();
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
        private HapticSurface board = null!;

        [SetUp]
        public void MakeABoardAndAnOutput()
        {
            FinishLoading();
            board = Board();
            Output(out _);
        }

        [UnityTest]
        public IEnumerator AStylusDisabledByItsFirstTouchLeavesNoVoiceOpen()
        {
            HapticStylus stylus = Resting();
            stylus.TouchBegan += (HapticStylus sender, in HapticContact _) => sender.enabled = false;
            yield return Frames(2);
            Assert.That(stylus.enabled, Is.False);
            Assert.That(Voices(), Is.Zero);
            Assert.That(stylus.IsTouching, Is.False);
        }

        [UnityTest]
        public IEnumerator AStylusDestroyedByItsFirstTouchLeavesNoVoiceOpen()
        {
            HapticStylus stylus = Resting();
            yield return null;
            stylus.TouchMoved += (HapticStylus sender, in HapticContact _) => Object.DestroyImmediate(sender);
            yield return Frames(2);
            Assert.That(Voices(), Is.Zero);
        }

        [UnityTest]
        public IEnumerator AStylusDisabledAndEnabledByAHandlerStartsANewTouch()
        {
            HapticStylus stylus = Resting();
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
            HapticStylus stylus = Resting();
            stylus.TouchBegan += (HapticStylus _, in HapticContact contact) =>
                Object.DestroyImmediate(contact.Surface!.gameObject);
            yield return Frames(2);
            Assert.That(stylus.IsTouching, Is.False);
            VoiceStatistics statistics = StatisticsOf(stylus);
            Assert.That(statistics.Updates, Is.GreaterThan(0UL));
            Assert.That(statistics.Onsets, Is.Zero);
        }

        [UnityTest]
        public IEnumerator ATouchBeginsWithTheMaterialThatItsHandlersGaveTheSurface()
        {
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0.1f * (float)seconds, 0.001f, 0f));
            stylus.TouchBegan += (HapticStylus _, in HapticContact _) => board.Material.Label = "nothing known";
            yield return Frames(20);
            Assert.That(stylus.IsTouching, Is.True);
            VoiceStatistics statistics = StatisticsOf(stylus);
            Assert.That((statistics.Onsets, statistics.Inferences), Is.EqualTo((0UL, 0UL)));
        }

        private static uint Voices() =>
            Haptics.TryGetStatistics(out EngineStatistics engine) ? engine.Voices : uint.MaxValue;
    }
}
