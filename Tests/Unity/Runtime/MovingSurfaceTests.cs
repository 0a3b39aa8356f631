#nullable enable
using System;
using System.Collections;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;

namespace HaptoFlow.Tests
{
    public sealed class MovingSurfaceTests : SceneTest
    {
        [UnityTest]
        public IEnumerator ATurningBoardGivesItsSpeedAtTheTip()
        {
            HapticSurface board = Board();
            var turner = board.gameObject.AddComponent<Turner>();
            turner.DegreesPerSecond = 90f;
            HapticStylus stylus = StylusAlong(_ => new Vector3(0.1f, 0.001f, 0f));
            yield return Frames(45);
            // 90 degrees per second at a distance of 10 cm.
            Assert.That(stylus.Contact.TangentialVelocity.magnitude, Is.EqualTo(0.1f * 0.5f * Mathf.PI).Within(0.004f));
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
        public IEnumerator ASurfaceWithoutOwnMotionCountsAsAtRest()
        {
            HapticSurface board = Board();
            board.FeelOwnMotion = false;
            PlatformMover.On(board.gameObject, RigidbodyInterpolation.Interpolate, seconds =>
                new Vector3(-0.1f + 0.2f * (float)seconds, 0f, 0f));
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0f, 0.001f, 0.05f * (float)seconds));
            yield return Frames(30);
            Assert.That(stylus.Contact.FirstVelocityMps, Is.EqualTo(0f).Within(1e-3f));
            Assert.That(stylus.Contact.TangentialVelocity.magnitude, Is.EqualTo(0.05f).Within(1e-3f));
        }

        private sealed class Turner : MonoBehaviour
        {
            public float DegreesPerSecond { get; set; }

            private void Update() => transform.rotation =
                Quaternion.AngleAxis(DegreesPerSecond * (float)Time.unscaledTimeAsDouble, Vector3.up);
        }
    }
}
