#nullable enable
using System;
using System.Collections;
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;

namespace HaptoFlow.Tests
{
    /// <summary>Start and end of a signal with a trembling hand and a noisy tracker.</summary>
    public sealed class MotionGateTests
    {
        private const double RateHz = 90.0;

        [Test]
        public void MotionIsDetectedInItsFirstFrameAndItsEndOneFrameLater()
        {
            var gate = new MotionGate();
            for (int frame = 0; frame < 90; ++frame)
            {
                double moved = Math.Min(Math.Max(0, frame - 30), 30) * 0.15 / RateHz;
                // The smallest noise that can be distinguished from a tracker that repeats positions.
                double noise = frame % 2 * 1e-6;
                bool moves = gate.Update(frame / RateHz, true, new Double3(moved + noise, 0.0, 0.0));
                Assert.That(moves, Is.EqualTo(frame > 30 && frame <= 60), $"frame {frame}");
            }
        }

        [TestCase(0.0)]
        [TestCase(0.03)]
        [TestCase(0.05)]
        public void TrackerNoiseAndTremorNeitherStartNorInterruptAMotion(double noiseMillimetres)
        {
            var random = new System.Random(1);
            var gate = new MotionGate();
            int changes = 0;
            bool before = false;
            for (int frame = 0; frame < 20 * 180; ++frame)
            {
                double seconds = frame / RateHz;
                double cycle = seconds % 2.0;
                double way = 0.15 * (Math.Floor(seconds / 2.0) + Math.Min(cycle, 1.0));
                // A tremor of 0.15 mm at 9 Hz has a peak speed of 8.5 mm/s.
                double tremor = 0.00015 * Math.Sin(2.0 * Math.PI * 9.0 * seconds);
                bool moves = gate.Update(seconds, true, new Double3(way + Noise(random), 0.0, tremor + Noise(random)));
                changes += moves != before ? 1 : 0;
                before = moves;
            }
            Assert.That(changes, Is.EqualTo(2 * 20).Within(1), "one start and one stop in two seconds");

            double Noise(System.Random source) => 0.001 * noiseMillimetres *
                Math.Sqrt(-2.0 * Math.Log(1.0 - source.NextDouble())) * Math.Cos(2.0 * Math.PI * source.NextDouble());
        }

        [Test]
        public void ARepeatedPositionDoesNotInterruptAMotionButARestingPenEndsIt()
        {
            var gate = new MotionGate();
            for (int frame = 0; frame < 60; ++frame)
            {
                // Two poses for three frames.
                double place = 0.15 * Math.Floor(2.0 * frame / 3.0) * 1.5 / RateHz;
                bool moves = gate.Update(frame / RateHz, true, new Double3(place, 0.0, 0.0));
                Assert.That(moves, Is.EqualTo(frame > 1), $"frame {frame}");
            }
            for (int frame = 60; frame < 70; ++frame)
            {
                gate.Update(frame / RateHz, true, new Double3(0.15 * 39.0 * 1.5 / RateHz, 0.0, 0.0));
            }
            Assert.That(gate.Moves, Is.False);
        }

        [Test]
        public void LiftingEndsTheMotionAndATouchElsewhereIsNotAMotion()
        {
            var gate = new MotionGate();
            gate.Update(0.0, true, new Double3(0.0, 0.0, 0.0));
            Assert.That(gate.Update(0.01, true, new Double3(0.01, 0.0, 0.0)), Is.True);
            Assert.That(gate.Update(0.02, false, new Double3(0.02, 0.0, 0.0)), Is.False);
            Assert.That(gate.Update(0.03, true, new Double3(0.5, 0.0, 0.0)), Is.False);
            Assert.That(gate.SpeedMps, Is.Zero);
        }

        [Test]
        public void AClockThatRunsBackwardsOrStandsStillChangesNothing()
        {
            var gate = new MotionGate();
            gate.Update(5.0, true, new Double3(0.0, 0.0, 0.0));
            gate.Update(5.01, true, new Double3(0.01, 0.0, 0.0));
            Assert.That(gate.Update(5.01, true, new Double3(0.3, 0.0, 0.0)), Is.True);
            Assert.That(gate.Update(1.0, true, new Double3(0.3, 0.0, 0.0)), Is.True);
            Assert.That(gate.SpeedMps, Is.EqualTo(1.0).Within(1e-9));
        }
    }

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

        [UnityTest]
        public IEnumerator AMeshOnAnInterpolatedBodyHasItsSpeed()
        {
            HapticSurface block = Tagged<MeshCollider>("wood", mesh => mesh.sharedMesh = TestMeshes.Box(0.4f));
            PlatformMover.On(block.gameObject, RigidbodyInterpolation.Interpolate, seconds =>
                new Vector3(-0.1f + 0.2f * (float)seconds, -0.2f, 0f));
            HapticStylus stylus = StylusAlong(_ => new Vector3(0f, 0.001f, 0f));
            yield return Frames(45);
            Assert.That(stylus.Contact.TangentialVelocity.magnitude, Is.EqualTo(0.2f).Within(0.01f));
        }

        private sealed class Turner : MonoBehaviour
        {
            public float DegreesPerSecond { get; set; }

            private void Update() => transform.rotation =
                Quaternion.AngleAxis(DegreesPerSecond * (float)Time.unscaledTimeAsDouble, Vector3.up);
        }
    }
}
