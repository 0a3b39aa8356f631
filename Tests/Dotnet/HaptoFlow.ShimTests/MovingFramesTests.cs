using System;
using System.Collections.Generic;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.ShimTests
{
    /// <summary>What moves a surface: each has its own delay between physics, drawing and the tip.</summary>
    public enum Carrier
    {
        /// <summary>A script in Update; no body.</summary>
        Transform,

        /// <summary>A script in Update moves the transform of a kinematic body.</summary>
        TransformOfBody,

        /// <summary>MovePosition in FixedUpdate.</summary>
        Stepped,

        /// <summary>MovePosition in FixedUpdate, drawn between the steps.</summary>
        Interpolated,

        /// <summary>A script in FixedUpdate moves a transform without a body.</summary>
        TransformInSteps,
    }

    /// <summary>Worlds that move, turn and are shifted under the tip: what rides along is at rest, and what slides has
    /// its speed in the frame of what it touches.</summary>
    public sealed class MovingFramesTests : SceneTest
    {
        private const float StillMps = 0.003f;

        private sealed class Mover : MonoBehaviour
        {
            public Func<double, Vector3> Path { get; set; } = _ => Vector3.zero;
            public bool Scaled { get; set; }

            private void Update() =>
                transform.localPosition = Path(Scaled ? Time.timeAsDouble : Time.unscaledTimeAsDouble);
        }

        private sealed class StepMover : MonoBehaviour
        {
            public Func<double, Vector3> Path { get; set; } = _ => Vector3.zero;

            private void FixedUpdate() => transform.position = Path(Time.fixedTimeAsDouble);
        }

        /// <summary>Steadily along x, whatever the clock's start.</summary>
        private static Func<double, Vector3> Steadily(double mps)
        {
            double? began = null;
            return now => new Vector3((float)(mps * (now - (began ??= now))), 0f, 0f);
        }

        private static void Carry(GameObject owner, Carrier carrier, double mps)
        {
            Func<double, Vector3> path = Steadily(mps);
            switch (carrier)
            {
                case Carrier.Transform:
                    owner.AddComponent<Mover>().Path = path;
                    break;
                case Carrier.TransformOfBody:
                    owner.AddComponent<Rigidbody>().isKinematic = true;
                    owner.AddComponent<Mover>().Path = path;
                    break;
                case Carrier.TransformInSteps:
                    owner.AddComponent<StepMover>().Path = path;
                    break;
                default:
                    PlatformMover.On(owner, carrier == Carrier.Stepped
                        ? RigidbodyInterpolation.None
                        : RigidbodyInterpolation.Interpolate, path);
                    break;
            }
        }

        private HapticStylus Pen(Func<double, Vector3> path, GameObject? parent = null)
        {
            GameObject made = Make("Pen");
            made.AddComponent<Mover>().Path = path;
            if (parent != null)
            {
                made.transform.SetParent(parent.transform, false);
            }
            return made.AddComponent<HapticStylus>();
        }

        private static Vector3 Circle(double seconds) => new Vector3(
            0.05f * (float)Math.Cos(4.0 * seconds), 0.001f, 0.05f * (float)Math.Sin(4.0 * seconds));

        /// <summary>Frames and steps per second: physics is slower than the frames, as fast, and faster.</summary>
        private static readonly (double Frames, double Steps)[] Rates =
            { (72.0, 50.0), (72.0, 90.0), (90.0, 90.0), (120.0, 100.0) };

        private static void SetRates((double Frames, double Steps) rates)
        {
            SetFrameRate(rates.Frames);
            Clock.FixedStepSeconds = 1.0 / rates.Steps;
        }

        /// <summary>The largest speed of the contact in as many frames.</summary>
        private static float Fastest(HapticStylus pen, int frames)
        {
            float most = 0f;
            for (int frame = 0; frame < frames; ++frame)
            {
                World.Frame();
                most = Math.Max(most, pen.Contact.TangentialVelocity.magnitude);
            }
            return most;
        }

        [Test, Pairwise]
        public void ATipThatRidesAlongIsAtRestAtEverySpeed([ValueSource(nameof(Rates))] (double, double) rates,
            [Values] Carrier carrier, [Values(0.05, 3.0, 250.0)] double mps)
        {
            SetRates(rates);
            GameObject vehicle = Make("Vehicle");
            Board().transform.SetParent(vehicle.transform, false);
            Carry(vehicle, carrier, mps);
            HapticStylus pen = Pen(_ => new Vector3(0.02f, 0.001f, 0.01f), vehicle);
            Assert.That(Fastest(pen, 90), Is.LessThan(StillMps));
            Assert.That(pen.IsTouching, Is.True);
            Assert.That(pen.Contact.TouchCounter, Is.EqualTo(1U));
        }

        /// <summary>The pen follows the same path in Update, as a hand in a vehicle that a script copies.</summary>
        [Test, Pairwise]
        public void ATipThatFollowsWithoutAParentIsAtRestAtEverySpeed([ValueSource(nameof(Rates))] (double, double) rates,
            [Values] Carrier carrier, [Values(0.05, 3.0, 250.0)] double mps)
        {
            SetRates(rates);
            HapticSurface ground = Board("wood", 2000f);
            Carry(ground.gameObject, carrier, mps);
            Func<double, Vector3> drive = Steadily(mps);
            HapticStylus pen = Pen(now => drive(now) + new Vector3(0.1f, 0.001f, 0.2f));
            World.Frames(40);
            // Unity's positions are single: 400 m from the origin a frame is 30 um out.
            double rounding = 3.0 * Math.Pow(2.0, -24.0) * mps * 120.0;
            Assert.That(Fastest(pen, 80), Is.LessThan(Math.Max(StillMps, rounding)));
            Assert.That(pen.IsTouching, Is.True);
        }

        /// <summary>A surface that moves steadily under a tip at rest, by whatever steps.</summary>
        [Test, Pairwise]
        public void ASteadySurfaceHasItsSpeedUnderATipAtRest([ValueSource(nameof(Rates))] (double Frames, double Steps) rates,
            [Values] Carrier carrier, [Values(0.02f, 0.2f, 1f)] float mps)
        {
            SetRates(rates);
            Carry(Board("wood", 40f).gameObject, carrier, mps);
            AssertSpeed(Pen(_ => new Vector3(0f, 0.001f, 0f)), mps, 0.1 + 2.0 / rates.Steps);
        }

        /// <summary>Ticks of a network, of an animation and of a slow tracker.</summary>
        [Test, Pairwise]
        public void ASurfaceThatMovesInTicksHasItsSpeedUnderATipAtRest([Values(72.0, 120.0)] double framesPerSecond,
            [Values(20.0, 45.0)] double ticksPerSecond, [Values(0.02f, 0.2f, 1f)] float mps, [Values(0.0, 0.5)] double phase)
        {
            SetFrameRate(framesPerSecond);
            Func<double, Vector3> drive = Steadily(mps);
            Board("wood", 40f).gameObject.AddComponent<Mover>().Path =
                now => drive((Math.Floor(now * ticksPerSecond + phase) - phase) / ticksPerSecond);
            AssertSpeed(Pen(_ => new Vector3(0f, 0.001f, 0f)), mps, 2.0 / ticksPerSecond + 0.1);
        }

        [Test]
        public void AShiftOfTheWorldIsOneTouchAtOneSpeed([Values] bool isMesh, [Values] bool withBody)
        {
            GameObject world = Make("World");
            HapticSurface ground = isMesh
                ? Tagged<MeshCollider>("wood", mesh => mesh.sharedMesh = TestMeshes.Box(1f))
                : Tagged<BoxCollider>("wood");
            ground.transform.SetParent(world.transform, false);
            ground.transform.localPosition = new Vector3(0f, -0.5f, 0f);
            if (withBody)
            {
                ground.gameObject.AddComponent<Rigidbody>().isKinematic = true;
            }
            HapticStylus pen = Pen(Circle, world);
            var log = new List<string>();
            World.Frames(40);
            pen.TouchBegan += (HapticStylus _, in HapticContact _) => log.Add("began");
            pen.TouchEnded += (HapticStylus _, in HapticContact _) => log.Add("ended");
            for (int shift = 0; shift < 4; ++shift)
            {
                world.transform.position = new Vector3(700f * (shift % 2 == 0 ? 1f : -1f), 0f, 3000f * (shift / 2));
                for (int frame = 0; frame < 17; ++frame)
                {
                    World.Frame();
                    // At three kilometres positions are rounded to a quarter of a millimetre.
                    Assert.That(pen.IsTouching, Is.True, $"shift {shift}, frame {frame}");
                    Assert.That(pen.Contact.TangentialVelocity.magnitude, Is.EqualTo(0.2f).Within(0.03f), $"shift {shift}, frame {frame}");
                }
            }
            Assert.That(log, Is.Empty);
            Assert.That(pen.Contact.TouchCounter, Is.EqualTo(1U));
        }

        /// <summary>Rig and pen turn, jump or are recentred in one frame, while the pen draws on the desk.</summary>
        [Test]
        public void SnapTurnsAndTeleportsMakeNoSound(
            [Values(72.0, 120.0)] double framesPerSecond, [Values(45f, 180f, 0f)] float degrees)
        {
            FinishLoading();
            SetFrameRate(framesPerSecond);
            Board("wood", 4f);
            AudioTap tap = Output(out _);
            GameObject rig = Make("Rig");
            HapticStylus pen = Pen(seconds => new Vector3(0.4f, 0f, 0f) + Circle(seconds), rig);
            World.Frames(90);
            float before = tap.Peak();
            tap.Restart();
            for (int turn = 0; turn < 3; ++turn)
            {
                if (degrees > 0f)
                {
                    rig.transform.rotation = Quaternion.AngleAxis(degrees, Vector3.up) * rig.transform.rotation;
                }
                else
                {
                    rig.transform.position = new Vector3(0.4f * (turn + 1), 0f, -0.2f * turn);
                }
                Assert.That(Fastest(pen, 30), Is.LessThan(0.21f), $"turn {turn}");
                Assert.That(pen.Contact.TangentialVelocity.magnitude, Is.EqualTo(0.2f).Within(0.01f));
            }
            Assert.That(tap.Peak(), Is.GreaterThan(0.3f * before).And.LessThan(2f * before));
            Assert.That(pen.ContactStatistics.Teleports, Is.EqualTo(3UL));
        }

        [Test]
        public void WhatAppearsUnderARestingPenIsSilent([Values(0.0, 1.5, 20.0)] double mps,
            [Values("switched on", "from a pool", "a second collider", "loaded")] string how)
        {
            FinishLoading();
            AudioTap tap = Output(out _);
            GameObject vehicle = Make("Vehicle");
            HapticSurface board = Board();
            board.transform.SetParent(vehicle.transform, false);
            vehicle.AddComponent<Mover>().Path = Steadily(mps);
            HapticStylus pen = Pen(_ => new Vector3(0.02f, 0.001f, 0.01f), vehicle);
            var collider = board.GetComponent<BoxCollider>();
            if (how == "a second collider" || how == "loaded")
            {
                collider.enabled = how != "loaded";
                World.Frames(30);
                GameObject second = how == "loaded" ? Tagged<BoxCollider>("stone").gameObject : board.gameObject;
                second.transform.SetParent(vehicle.transform, false);
                BoxCollider added = how == "loaded" ? second.GetComponent<BoxCollider>() : second.AddComponent<BoxCollider>();
                added.size = new Vector3(0.4f, 0.02f, 0.4f);
                added.center = new Vector3(0f, -0.0095f, 0f);
            }
            else if (how == "switched on")
            {
                collider.enabled = false;
                World.Frames(30);
                collider.enabled = true;
            }
            else
            {
                board.transform.localPosition = new Vector3(0f, -100f, 0f);
                World.Frames(30);
                board.transform.localPosition = Vector3.zero;
            }
            tap.Restart();
            for (int frame = 0; frame < 40; ++frame)
            {
                World.Frame();
                Assert.That(pen.Contact.TangentialVelocity.magnitude, Is.LessThan(StillMps), $"frame {frame}");
                Assert.That(pen.Contact.ApproachSpeedMps, Is.LessThan(StillMps), $"frame {frame}");
            }
            Assert.That(pen.IsTouching, Is.True);
            Assert.That(tap.Peak(), Is.LessThan(0.001f));
        }

        /// <summary>Slow motion and hitches beyond the largest step: the pen follows the world's clock on a platform of
        /// physics.</summary>
        [Test]
        public void APenAtRestOnAPlatformIsAtRestInSlowMotionAndAfterHitches([Values] Carrier carrier)
        {
            HapticSurface ground = Board("wood", 40f);
            Carry(ground.gameObject, carrier, 0.2);
            if (ground.TryGetComponent(out Mover mover))
            {
                mover.Scaled = true;
            }
            Func<double, Vector3> drive = Steadily(0.2);
            HapticStylus pen = Pen(now => drive(now) + new Vector3(0f, 0.001f, 0f));
            pen.GetComponent<Mover>().Scaled = true;
            World.Frames(60);
            foreach (double scale in new[] { 1.0, 0.5, 0.1, 1.0, 2.0, 0.05, 1.0 })
            {
                Clock.Scale = scale;
                World.Frames(40);
                float most = 0f;
                for (int frame = 0; frame < 60; ++frame)
                {
                    World.Frame(frame == 30 ? 0.21 : frame == 50 ? 0.9 : 1.0 / 90.0);
                    most = Math.Max(most, pen.Contact.TangentialVelocity.magnitude);
                }
                // After a hitch in slow motion a step of physics is a fifth of a second away: for a moment the pen has its own speed.
                Assert.That(most, Is.LessThan(0.021f), $"time at {scale}");
            }
        }

        [TestCase(0.1f)]
        [TestCase(0.5f)]
        [TestCase(3f)]
        [TestCase(10f)]
        public void UnderAScaledRigSpeedDepthAndForceAreTheHands(float scale)
        {
            Board("wood", 40f);
            GameObject rig = Make("Rig");
            rig.transform.localScale = new Vector3(scale, scale, scale);
            HapticStylus pen = Pen(Circle, rig);
            World.Frames(90);
            Assert.That(pen.IsTouching, Is.True);
            Assert.That(pen.Contact.TangentialVelocity.magnitude, Is.EqualTo(0.2f).Within(0.004f));
            Assert.That(pen.Contact.PenetrationMetres, Is.EqualTo(0.001f).Within(2e-5f));
            Assert.That(pen.Contact.ForceNewtons, Is.GreaterThan(0.1f));
            Assert.That(pen.Contact.Point.x, Is.EqualTo(scale * 0.05f * (float)Math.Cos(4.0 * Clock.UnscaledSeconds)).Within(1e-4f * scale));
            // The rig grows in the hand of its user: no stroke.
            float grown = 1.5f * scale;
            rig.transform.localScale = new Vector3(grown, grown, grown);
            Assert.That(Fastest(pen, 60), Is.LessThan(0.21f));
            Assert.That(pen.Contact.TangentialVelocity.magnitude, Is.EqualTo(0.2f).Within(0.004f));
        }

        [TestCase(false)]
        [TestCase(true)]
        public void ThePensOwnScaleIsNoRigNorIsItsRootsWhereARigIsNamed(bool isNamed)
        {
            Board("wood", 4f);
            GameObject world = Make("World");
            HapticStylus pen = Pen(Circle, isNamed ? world : null);
            pen.transform.localScale = new Vector3(0.01f, 0.01f, 0.01f);
            if (isNamed)
            {
                world.transform.localScale = new Vector3(1.5f, 1.5f, 1.5f);
                pen.Rig = Make("Rig").transform;
            }
            World.Frames(90);
            Assert.That(pen.Contact.TangentialVelocity.magnitude, Is.EqualTo(isNamed ? 0.3f : 0.2f).Within(0.006f));
        }

        private sealed class Follower : MonoBehaviour
        {
            public Rigidbody Body = null!;
            public Transform Hand = null!;

            private void FixedUpdate() => Body.MovePosition(Hand.position);
        }

        /// <summary>A tip that physics moves after a tracked hand: the steps of a hitch wait for the next frame.</summary>
        [Test]
        public void AHitchIsNoStrokeInFixedUpdates(
            [Values(0.05, 0.2, 0.6)] double hitch, [Values(0.01, 0.025)] double step)
        {
            Clock.FixedStepSeconds = step;
            Board("wood", 4f);
            GameObject hand = Make("Hand");
            hand.AddComponent<Mover>().Path = Circle;
            GameObject made = Make("Tip");
            Follower follower = made.AddComponent<Follower>();
            follower.Body = made.AddComponent<Rigidbody>();
            follower.Body.isKinematic = true;
            follower.Hand = hand.transform;
            HapticStylus pen = made.AddComponent<HapticStylus>();
            pen.UpdateMode = StylusUpdate.FixedUpdates;
            World.Frames(180);
            float most = 0f;
            for (int frame = 0; frame < 135; ++frame)
            {
                World.Frame(frame % 45 == 0 ? hitch : 1.0 / 90.0);
                most = Math.Max(most, pen.Contact.TangentialVelocity.magnitude);
            }
            Assert.That(most, Is.LessThan(0.45f), "the hand moves at 0.2 m/s");
            Assert.That(pen.Contact.TangentialVelocity.magnitude, Is.EqualTo(0.2f).Within(0.1f));
        }

        /// <summary>States that come every 100 ms, or every 200, are not stale.</summary>
        [TestCase(10.0, 0.02, StylusUpdate.RenderedFrames)]
        [TestCase(7.0, 0.02, StylusUpdate.RenderedFrames)]
        [TestCase(72.0, 0.1, StylusUpdate.FixedUpdates)]
        [TestCase(72.0, 0.2, StylusUpdate.FixedUpdates)]
        public void AStrokeSoundsOnWhereStatesComeSeldom(double framesPerSecond, double step, StylusUpdate update)
        {
            FinishLoading();
            SetFrameRate(framesPerSecond);
            Clock.FixedStepSeconds = step;
            Board();
            Output(out _);
            HapticStylus pen = Pen(Circle);
            pen.UpdateMode = update;
            World.Frames((int)(2.0 * framesPerSecond));
            AudioDevice.Forget();
            World.Frames((int)(3.0 * framesPerSecond));
            int silent = 0;
            int blocks = AudioDevice.RecordedFrames / 480;
            for (int block = 0; block < blocks; ++block)
            {
                float peak = 0f;
                for (int frame = 480 * block; frame < 480 * (block + 1); ++frame)
                {
                    peak = Math.Max(peak, Math.Abs(AudioDevice.Sample(frame, 0)));
                }
                silent += peak < 1e-4f ? 1 : 0;
            }
            Assert.That(silent, Is.LessThan(0.03 * blocks), $"of {blocks} blocks of 10 ms");
        }

        private static void AssertSpeed(HapticStylus pen, float mps, double fromSeconds)
        {
            double squares = 0.0;
            int frames = 0;
            double began = Clock.UnscaledSeconds;
            while (Clock.UnscaledSeconds < began + 1.5)
            {
                World.Frame();
                float error = pen.Contact.FirstVelocityMps + mps;
                Assert.That(pen.Contact.FirstVelocityMps, Is.LessThan(0.05f * mps), "wrong sign");
                Assert.That(Math.Abs(pen.Contact.FirstVelocityMps), Is.LessThan(1.6f * mps), $"after {Clock.UnscaledSeconds - began:0.000} s");
                if (Clock.UnscaledSeconds > began + fromSeconds)
                {
                    squares += error * error;
                    ++frames;
                }
            }
            Assert.That(Math.Sqrt(squares / frames), Is.LessThan(0.1 * mps));
        }
    }
}
