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
        private static readonly double[] FrameRatesHz = { 72.0, 90.0, 120.0 };

        [UnityTest]
        public IEnumerator ABodySteppedAt50HzKeepsTheRelativeSpeedWithinFivePercent() =>
            RelativeSpeed(RigidbodyInterpolation.None);

        [UnityTest]
        public IEnumerator AnInterpolatedBodyKeepsTheRelativeSpeedWithinFivePercent() =>
            RelativeSpeed(RigidbodyInterpolation.Interpolate);

        /// <summary>A tip at rest over a board that moves at 0.2 m/s, at the frame rates of headsets.</summary>
        private IEnumerator RelativeSpeed(RigidbodyInterpolation interpolation)
        {
            foreach (double rate in FrameRatesHz)
            {
                SetFrameRate(rate);
                HapticSurface board = Board();
                PlatformMover.On(board.gameObject, interpolation, seconds => new Vector3(-0.15f + 0.2f * (float)seconds, 0f, 0f));
                HapticStylus stylus = StylusAlong(_ => new Vector3(0f, 0.001f, 0f));
                for (int frame = 0; frame < 20; ++frame)
                {
                    yield return null;
                }
                for (int frame = 0; frame < 40; ++frame)
                {
                    yield return null;
                    Assert.That(stylus.Contact.FirstVelocityMps, Is.EqualTo(-0.2f).Within(0.01f), $"{rate} Hz, " +
                        $"frame {frame}");
                    Assert.That(stylus.Contact.SecondVelocityMps, Is.EqualTo(0f).Within(0.01f));
                }
                UnityEngine.Object.DestroyImmediate(stylus.gameObject);
                UnityEngine.Object.DestroyImmediate(board.gameObject);
            }
        }

        [UnityTest]
        public IEnumerator ATipAtRestOnAMovingBodyHasNoVelocity()
        {
            HapticSurface board = Board();
            PlatformMover.On(board.gameObject, RigidbodyInterpolation.Interpolate, seconds =>
                new Vector3(0.05f * (float)Math.Sin(4.0 * seconds), 0f, 0f));
            HapticStylus stylus = StylusAlong(_ => new Vector3(0f, 0.001f, 0f));
            GameObject tip = Make("tip");
            tip.transform.SetParent(board.transform, false);
            tip.transform.localPosition = new Vector3(0.02f, 0.001f, 0.01f);
            stylus.Tip = tip.transform;
            for (int frame = 0; frame < 90; ++frame)
            {
                yield return null;
                Assert.That(stylus.Contact.TangentialVelocity.magnitude, Is.LessThan(0.003f), $"frame {frame}");
            }
            Assert.That(stylus.IsTouching, Is.True);
        }

        [UnityTest]
        public IEnumerator ATurningBoardGivesItsSpeedAtTheTip()
        {
            HapticSurface board = Board();
            var turner = board.gameObject.AddComponent<Turner>();
            turner.DegreesPerSecond = 90f;
            HapticStylus stylus = StylusAlong(_ => new Vector3(0.1f, 0.001f, 0f));
            for (int frame = 0; frame < 45; ++frame)
            {
                yield return null;
            }
            // 90 degrees per second at a distance of 10 cm.
            Assert.That(stylus.Contact.TangentialVelocity.magnitude, Is.EqualTo(0.1f * 0.5f * Mathf.PI).Within(0.004f));
        }

        [UnityTest]
        public IEnumerator TheAxesTurnWithTheObject()
        {
            HapticSurface board = Board();
            board.transform.rotation = Quaternion.AngleAxis(90f, Vector3.up);
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0f, 0.001f, -0.05f * (float)seconds));
            for (int frame = 0; frame < 30; ++frame)
            {
                yield return null;
            }
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
            for (int frame = 0; frame < 30; ++frame)
            {
                yield return null;
            }
            Assert.That(stylus.Contact.FirstVelocityMps, Is.EqualTo(0f).Within(1e-3f));
            Assert.That(stylus.Contact.TangentialVelocity.magnitude, Is.EqualTo(0.05f).Within(1e-3f));
        }

        [UnityTest]
        public IEnumerator TheTipIsTrackedInFixedUpdatesToo()
        {
            Board();
            HapticStylus stylus = StylusAlong(seconds => new Vector3(0.05f * (float)seconds, 0.001f, 0f));
            stylus.UpdateMode = StylusUpdate.FixedUpdates;
            for (int frame = 0; frame < 60; ++frame)
            {
                yield return null;
            }
            Assert.That(stylus.IsTouching, Is.True);
            Assert.That(stylus.Contact.FirstVelocityMps, Is.EqualTo(0.05f).Within(0.01f));
        }

        private sealed class Turner : MonoBehaviour
        {
            public float DegreesPerSecond { get; set; }

            private void Update() => transform.rotation =
                Quaternion.AngleAxis(DegreesPerSecond * (float)Time.unscaledTimeAsDouble, Vector3.up);
        }
    }
}
