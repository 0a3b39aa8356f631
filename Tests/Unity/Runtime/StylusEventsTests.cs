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
}
