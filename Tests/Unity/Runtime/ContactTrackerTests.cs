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
    /// <summary>The contact model by itself, over horizontal planes at 90 frames a second.</summary>
    public sealed class ContactTrackerTests
    {
        private ContactTracker tracker = null!;
        private ContactBody low = null!;
        private ContactBody high = null!;
        private int frame;

        [SetUp]
        public void Start()
        {
            tracker = new ContactTracker(0.002);
            low = new ContactBody(Double3.Right, 0.0);
            high = new ContactBody(Double3.Right, 0.0);
            frame = 0;
        }

        private ContactReading Frame(Double3 tip, double? force, params (ContactBody Surface, double Height)[] planes)
        {
            double seconds = ++frame / 90.0;
            if (tracker.BeginFrame(new TipSample(seconds, tip, force)))
            {
                foreach ((ContactBody surface, double height) in planes)
                {
                    Consider(surface, height, tip, new Double3(1.0, 1.0, 1.0));
                }
            }
            return tracker.EndFrame();
        }

        private void StandStill()
        {
            for (int still = 0; still < 10; ++still)
            {
                Frame(new Double3(0.1, 0.001, 0.0), null, (low, 0.0));
            }
        }

        private void Consider(ContactBody surface, double height, Double3 tip, Double3 scale)
        {
            var pose = new RigidPose(new Double3(0.0, height, 0.0), Rotation.Identity);
            surface.Track.Record(tracker.NowSeconds, pose, scale, double.NaN);
            tracker.AdvancePath(surface, pose);
            tracker.Consider(new ContactCandidate(
                surface, pose, new SurfacePoint(new Double3(tip.X, 0.0, tip.Z), Double3.Up, tip.Y - height)));
        }

        [TestCase(true)]
        [TestCase(false)]
        public void APressedPenTouchesTheNearestSurfaceAndLeavesItForOneThatIsNearerByAMargin(bool lowFirst)
        {
            tracker.Force = new ForceTouch();
            (ContactBody, double)[] planes = lowFirst
                ? new[] { (low, 0.0), (high, 0.005) }
                : new[] { (high, 0.005), (low, 0.0) };
            Assert.That(Frame(new Double3(0.0, 0.01, 0.0), 0.5, planes).Surface, Is.SameAs(high));
            Assert.That(Frame(new Double3(0.0, 0.0044, 0.0), 0.5, planes).Surface, Is.SameAs(high), "nearer by too little");
            Assert.That(Frame(new Double3(0.0, 0.001, 0.0), 0.5, planes).Surface, Is.SameAs(low));
            Assert.That(Frame(new Double3(0.0, 0.001, 0.0), 0.0, planes).Surface, Is.Null, "lifted");
        }

        [TestCase(double.NaN)]
        [TestCase(double.PositiveInfinity)]
        public void AForceThatIsNoNumberIsCountedAndTheSpringGivesIt(double force)
        {
            ContactReading reading = Frame(new Double3(0.0, 0.001, 0.0), force, (low, 0.0));
            Assert.That(reading.State.ForceNewtons, Is.EqualTo(0.5f).Within(1e-6f));
            Assert.That(tracker.Statistics.SanitisedSamples, Is.EqualTo(1UL));
        }

        /// <summary>A scale of 0 has no place to keep: the tip stays in the world.</summary>
        [TestCase(2.0, 0.2)]
        [TestCase(-1.0, -0.1)]
        [TestCase(0.0, 0.1)]
        public void ATipThatStaysOnItsPlaceOfASurfaceWithAnotherScaleIsAtRest(double scale, double x)
        {
            StandStill();
            var tip = new Double3(x, 0.001, 0.0);
            Assert.That(tracker.BeginFrame(new TipSample(++frame / 90.0, tip)), Is.True);
            Consider(low, 0.0, tip, new Double3(scale, 1.0, 1.0));
            ContactReading reading = tracker.EndFrame();
            Assert.That(reading.Surface, Is.SameAs(low));
            Assert.That(reading.State.FirstVelocityMps, Is.EqualTo(0f).Within(1e-4f));
            Assert.That(reading.State.TouchCounter, Is.EqualTo(1u));
        }

        [Test]
        public void ASurfaceWhoseMotionIsNoLongerFeltIsTouchedOnInTheWorld()
        {
            StandStill();
            var tip = new Double3(0.1, 0.001, 0.0);
            Assert.That(tracker.BeginFrame(new TipSample(++frame / 90.0, tip)), Is.True);
            low.Track.Clear();
            tracker.Consider(new ContactCandidate(
                low, RigidPose.Identity, new SurfacePoint(tip.With(1, 0.0), Double3.Up, tip.Y)));
            ContactReading reading = tracker.EndFrame();
            Assert.That((reading.Surface, reading.State.TouchCounter), Is.EqualTo((low, 1u)));
            Assert.That(reading.State.FirstVelocityMps, Is.EqualTo(0f).Within(1e-4f));
        }
    }

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
            Board().gameObject.AddComponent<Turner>().DegreesPerSecond = 90f;
            HapticStylus stylus = Resting(0.1f);
            yield return Frames(45);
            // 90 degrees per second at a distance of 10 cm.
            Assert.That(stylus.Contact.TangentialVelocity.magnitude, Is.EqualTo(0.1f * 0.5f * Mathf.PI).Within(0.004f));
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
            HapticStylus stylus = Resting();
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
