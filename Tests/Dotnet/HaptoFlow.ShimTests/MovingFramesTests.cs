using System;
using System.Collections.Generic;
using HaptoFlow.Tests;
using NUnit.Framework;
using UnityEngine;
using UnityShim;
using Object = UnityEngine.Object;

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

        /// <summary>Moves an object in Update.</summary>
        private sealed class Mover : MonoBehaviour
        {
            public Func<double, Vector3> Path { get; set; } = _ => Vector3.zero;
            public Func<double, Quaternion>? Turn { get; set; }
            public bool Local { get; set; }
            public bool Scaled { get; set; }

            private void Update()
            {
                double now = Scaled ? Time.timeAsDouble : Time.unscaledTimeAsDouble;
                if (Local)
                {
                    transform.localPosition = Path(now);
                }
                else
                {
                    transform.position = Path(now);
                }
                if (Turn != null)
                {
                    transform.rotation = Turn(now);
                }
            }
        }

        /// <summary>Moves a transform in FixedUpdate.</summary>
        private sealed class StepMover : MonoBehaviour
        {
            public Func<double, Vector3> Path { get; set; } = _ => Vector3.zero;

            private void FixedUpdate() => transform.position = Path(Time.fixedTimeAsDouble);
        }

        /// <summary>Moves an object at ticks of its own, as a network does.</summary>
        private sealed class TickMover : MonoBehaviour
        {
            public Func<double, Vector3> Path { get; set; } = _ => Vector3.zero;
            public double TicksPerSecond { get; set; }
            public double Phase { get; set; }

            private void Update() => transform.position =
                Path((Math.Floor(Time.unscaledTimeAsDouble * TicksPerSecond + Phase) - Phase) / TicksPerSecond);
        }

        private static void Carry(GameObject owner, Carrier carrier, Func<double, Vector3> path)
        {
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
            Mover mover = made.AddComponent<Mover>();
            mover.Path = path;
            if (parent != null)
            {
                made.transform.SetParent(parent.transform, false);
                mover.Local = true;
            }
            return made.AddComponent<HapticStylus>();
        }

        private HapticSurface Ground(float metres) => Tagged<BoxCollider>("wood", box =>
        {
            box.size = new Vector3(metres, 0.02f, metres);
            box.center = new Vector3(0f, -0.01f, 0f);
        });

        private static Vector3 Circle(double seconds) => new Vector3(
            0.05f * (float)Math.Cos(4.0 * seconds), 0.001f, 0.05f * (float)Math.Sin(4.0 * seconds));

        private void Clear(params GameObject[] made)
        {
            foreach (GameObject each in made)
            {
                Object.DestroyImmediate(each);
            }
        }

        public static IEnumerable<TestCaseData> Rates()
        {
            foreach (double framesPerSecond in new[] { 72.0, 90.0, 120.0 })
            {
                foreach (double stepsPerSecond in new[] { 50.0, 72.0, 90.0, 100.0, 120.0 })
                {
                    yield return new TestCaseData(framesPerSecond, stepsPerSecond);
                }
            }
        }

        [TestCaseSource(nameof(Rates))]
        public void ATipThatRidesAlongIsAtRestAtEverySpeed(double framesPerSecond, double stepsPerSecond)
        {
            SetFrameRate(framesPerSecond);
            Clock.FixedStepSeconds = 1.0 / stepsPerSecond;
            foreach (Carrier carrier in Enum.GetValues(typeof(Carrier)))
            {
                foreach (double speed in new[] { 0.05, 0.5, 3.0, 20.0, 30.0, 250.0 })
                {
                    double began = Clock.UnscaledSeconds;
                    Vector3 Drive(double now) => new Vector3((float)(speed * (now - began)), 0f, 0f);
                    GameObject vehicle = Make("Vehicle");
                    HapticSurface panel = Board();
                    panel.transform.SetParent(vehicle.transform, false);
                    double beganSteps = Clock.FixedSeconds;
                    Carry(vehicle, carrier, carrier == Carrier.Stepped || carrier == Carrier.Interpolated
                        ? now => new Vector3((float)(speed * now), 0f, 0f)
                        : carrier == Carrier.TransformInSteps
                            ? now => new Vector3((float)(speed * (now - beganSteps)), 0f, 0f)
                            : (Func<double, Vector3>)Drive);
                    HapticStylus pen = Pen(_ => new Vector3(0.02f, 0.001f, 0.01f), vehicle);
                    float most = 0f;
                    for (int frame = 0; frame < 90; ++frame)
                    {
                        World.Frame();
                        most = Math.Max(most, pen.Contact.TangentialVelocity.magnitude);
                        Assert.That(frame < 2 || pen.IsTouching, Is.True, $"{carrier}, {speed} m/s, frame {frame}");
                    }
                    Assert.That(most, Is.LessThan(StillMps), $"{carrier}, {speed} m/s");
                    Assert.That(pen.Contact.TouchCounter, Is.EqualTo(1U), $"{carrier}, {speed} m/s");
                    Clear(pen.gameObject, panel.gameObject, vehicle);
                }
            }
        }

        /// <summary>The pen follows the same path in Update, as a hand in a vehicle that a script copies.</summary>
        [TestCaseSource(nameof(Rates))]
        public void ATipThatFollowsWithoutAParentIsAtRestAtEverySpeed(double framesPerSecond, double stepsPerSecond)
        {
            SetFrameRate(framesPerSecond);
            Clock.FixedStepSeconds = 1.0 / stepsPerSecond;
            foreach (Carrier carrier in Enum.GetValues(typeof(Carrier)))
            {
                foreach (double speed in new[] { 0.05, 0.5, 3.0, 30.0, 250.0 })
                {
                    HapticSurface ground = Ground(2000f);
                    double began = Clock.Seconds;
                    Vector3 Drive(double now) => new Vector3((float)(speed * (now - began)), 0f, 0f);
                    double late = Clock.FixedSeconds - began;
                    Carry(ground.gameObject, carrier, carrier == Carrier.Stepped || carrier == Carrier.Interpolated
                        ? now => new Vector3((float)(speed * (now + late)), 0f, 0f)
                        : (Func<double, Vector3>)Drive);
                    HapticStylus pen = Pen(now => Drive(now) + new Vector3(0.1f, 0.001f, 0.2f));
                    float most = 0f;
                    for (int frame = 0; frame < 120; ++frame)
                    {
                        World.Frame();
                        most = frame < 40 ? 0f : Math.Max(most, pen.Contact.TangentialVelocity.magnitude);
                    }
                    Assert.That(pen.IsTouching, Is.True);
                    Assert.That(most, Is.LessThan(StillMps), $"{carrier}, {speed} m/s");
                    Clear(pen.gameObject, ground.gameObject);
                }
            }
        }

        /// <summary>A surface that moves steadily under a tip at rest, by whatever steps.</summary>
        [TestCaseSource(nameof(Rates))]
        public void ASteadySurfaceHasItsSpeedUnderATipAtRest(double framesPerSecond, double stepsPerSecond)
        {
            SetFrameRate(framesPerSecond);
            Clock.FixedStepSeconds = 1.0 / stepsPerSecond;
            foreach (Carrier carrier in Enum.GetValues(typeof(Carrier)))
            {
                foreach (float speed in new[] { 0.02f, 0.2f, 1f })
                {
                    HapticSurface ground = Ground(40f);
                    double began = Clock.FixedSeconds;
                    Carry(ground.gameObject, carrier, carrier == Carrier.Stepped || carrier == Carrier.Interpolated
                        ? now => new Vector3(speed * (float)now, 0f, 0f)
                        : now => new Vector3(speed * (float)(now - began), 0f, 0f));
                    HapticStylus pen = Pen(_ => new Vector3(0f, 0.001f, 0f));
                    AssertSpeed(pen, speed, 0.1 + 2.0 / stepsPerSecond, $"{carrier}, {speed} m/s");
                    Clear(pen.gameObject, ground.gameObject);
                }
            }
        }

        /// <summary>Ticks of a network, of an animation and of a slow tracker.</summary>
        [Test]
        public void ASurfaceThatMovesInTicksHasItsSpeedUnderATipAtRest(
            [Values(72.0, 90.0, 120.0)] double framesPerSecond, [Values(20.0, 24.0, 30.0, 45.0, 60.0)] double ticksPerSecond)
        {
            SetFrameRate(framesPerSecond);
            foreach (float speed in new[] { 0.02f, 0.2f, 1f })
            {
                for (int phase = 0; phase < 4; ++phase)
                {
                    HapticSurface ground = Ground(40f);
                    double began = Clock.UnscaledSeconds;
                    TickMover mover = ground.gameObject.AddComponent<TickMover>();
                    mover.Path = now => new Vector3(speed * (float)(now - began), 0f, 0f);
                    mover.TicksPerSecond = ticksPerSecond;
                    mover.Phase = 0.25 * phase;
                    HapticStylus pen = Pen(_ => new Vector3(0f, 0.001f, 0f));
                    AssertSpeed(pen, speed, 2.0 / ticksPerSecond + 0.1, $"{speed} m/s, phase {phase}");
                    Clear(pen.gameObject, ground.gameObject);
                }
            }
        }

        private static void AssertSpeed(HapticStylus pen, float speed, double fromSeconds, string what)
        {
            double squares = 0.0;
            int frames = 0;
            double began = Clock.UnscaledSeconds;
            while (Clock.UnscaledSeconds < began + 1.5)
            {
                World.Frame();
                float error = pen.Contact.FirstVelocityMps + speed;
                Assert.That(pen.Contact.FirstVelocityMps, Is.LessThan(0.05f * speed), $"{what}: wrong sign");
                Assert.That(Math.Abs(pen.Contact.FirstVelocityMps), Is.LessThan(1.6f * speed), $"{what} after {Clock.UnscaledSeconds - began:0.000} s");
                if (Clock.UnscaledSeconds > began + fromSeconds)
                {
                    squares += error * error;
                    ++frames;
                }
            }
            Assert.That(Math.Sqrt(squares / frames), Is.LessThan(0.1 * speed), what);
        }
    }
}
