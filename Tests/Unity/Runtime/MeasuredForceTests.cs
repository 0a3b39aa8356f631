#nullable enable
using System;
using System.Collections;
using System.Linq;
using HaptoFlow.Contact;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;

namespace HaptoFlow.Tests
{
    /// <summary>A pen on a real object below a virtual one: the force decides, despite tracking errors of
    /// millimetres.</summary>
    public sealed class MeasuredForceTests : SceneTest
    {
        private const float Audible = 0.001f;

        private FixedForce force = null!;

        [UnityTest]
        public IEnumerator APressingPenTouchesAndSlidesOverASurfaceMillimetresAway()
        {
            FinishLoading();
            HapticSurface board = Board();
            AudioTap tap = Output(out _);
            HapticStylus stylus = Pen(seconds => new Vector3(0.1f * (float)seconds - 0.1f, 0.009f, 0f));
            force.ForceNewtons = 1.25f;
            yield return Frames(60);
            Assert.That(stylus.IsTouching, Is.True);
            Assert.That(stylus.Contact.Surface, Is.SameAs(board));
            Assert.That(stylus.Contact.ForceNewtons, Is.EqualTo(1.25f).Within(1e-6f));
            Assert.That(stylus.Contact.FirstVelocityMps, Is.EqualTo(0.1f).Within(0.01f));
            Assert.That(tap.Peak(), Is.GreaterThan(Audible));
        }

        [UnityTest]
        public IEnumerator APenInTheAirTouchesNothingAlsoInsideAVirtualObject()
        {
            Board();
            HapticStylus stylus = Pen(_ => new Vector3(0f, -0.002f, 0f));
            yield return Press(stylus, 0f, false);
            stylus.TouchBy = TouchDecision.Geometry;
            yield return Press(stylus, 0f, true);
            stylus.TouchBy = TouchDecision.MeasuredForce;
            yield return Press(stylus, 0f, false);
        }

        [UnityTest]
        public IEnumerator APenThatPressesFarFromEverySurfaceTouchesNothing()
        {
            Board();
            HapticStylus stylus = Pen(_ => new Vector3(0f, 0.03f, 0f));
            yield return Press(stylus, 2f, false);
            stylus.ForceDecision.NearMetres = 0.035f;
            yield return Press(stylus, 2f, true);
        }

        [UnityTest]
        public IEnumerator LiftingEndsTheTouchInTheSameFrameAndPressingAgainStartsANewOne()
        {
            Board();
            HapticStylus stylus = Pen(_ => new Vector3(0f, 0.006f, 0f));
            var log = new TouchLog(stylus);
            force.ForceNewtons = 1f;
            yield return Frames(3);
            force.ForceNewtons = 0.01f;
            yield return Frames(1);
            Assert.That(log.Ended, Is.EqualTo(1));
            force.ForceNewtons = 1f;
            yield return Frames(1);
            Assert.That(log.Began, Is.EqualTo(2));
            Assert.That(stylus.Contact.TouchCounter, Is.EqualTo(2u));
        }

        [UnityTest]
        public IEnumerator ChangedThresholdsApplyAtOnceAndInvalidOnesAreCorrected()
        {
            Board();
            HapticStylus stylus = Pen(_ => new Vector3(0f, 0.006f, 0f));
            yield return Press(stylus, 0.3f, true);
            stylus.ForceDecision.PressNewtons = 0.5f;
            stylus.ForceDecision.ReleaseNewtons = 5f;
            yield return Press(stylus, 0.3f, false);
            yield return Press(stylus, 0.5f, true);
            yield return Press(stylus, 0.46f, true);
            yield return Press(stylus, 0.44f, false);
        }

        [UnityTest]
        public IEnumerator WithoutAForceSourceGeometryDecides()
        {
            Board();
            HapticStylus stylus = Resting();
            stylus.TouchBy = TouchDecision.MeasuredForce;
            yield return Frames(3);
            Assert.That(stylus.IsTouching, Is.True);
            Assert.That(stylus.Contact.PenetrationMetres, Is.EqualTo(0.001f).Within(1e-5f));
        }

        private IEnumerator Press(HapticStylus stylus, float newtons, bool touches)
        {
            force.ForceNewtons = newtons;
            yield return Frames(2);
            Assert.That(stylus.IsTouching, Is.EqualTo(touches));
        }

        private HapticStylus Pen(Func<double, Vector3> path)
        {
            HapticStylus stylus = StylusAlong(path);
            force = stylus.gameObject.AddComponent<FixedForce>();
            stylus.Force = force;
            stylus.TouchBy = TouchDecision.MeasuredForce;
            return stylus;
        }
    }

    /// <summary>The force detector alone, without scene and geometry.</summary>
    public sealed class ForceTouchTests
    {
        private const double FrameSeconds = 1.0 / 90.0;

        private ForceTouch touch = null!;
        private double now;

        [SetUp]
        public void TakeAPen()
        {
            touch = new ForceTouch();
            now = 100.0;
        }

        [Test]
        public void ATouchBeginsAtThePressForceAndEndsAtTheReleaseForce() => Assert.That(
            new[] { 0.0, 0.049, 0.05, 0.021, 0.02, 0.049 }.Select(newtons => After(newtons)), Is.EqualTo(new[]
            {
                ForceVerdict.Lifted, ForceVerdict.Lifted, ForceVerdict.Pressed, ForceVerdict.Pressed,
                ForceVerdict.Lifted, ForceVerdict.Lifted,
            }));

        [Test]
        public void SensorNoiseBelowTheHysteresisCausesOneTouchHoweverSlowThePenIs()
        {
            var random = new System.Random(7);
            int touches = 0;
            ForceVerdict before = ForceVerdict.Lifted;
            for (int frame = 0; frame < 900; ++frame)
            {
                double ramp = 0.4 * Math.Min(frame, 900 - frame) / 450.0;
                double noise = 0.014 * (2.0 * random.NextDouble() - 1.0);
                ForceVerdict verdict = After(Math.Max(0.0, ramp + noise));
                touches += verdict == ForceVerdict.Pressed && before != ForceVerdict.Pressed ? 1 : 0;
                before = verdict;
            }
            Assert.That(touches, Is.EqualTo(1));
            Assert.That(before, Is.EqualTo(ForceVerdict.Lifted));
        }

        [Test]
        public void AShortDropoutKeepsTheTouchAndItsForceAndALongOneEndsIt()
        {
            After(1.5);
            Assert.That(After(null), Is.EqualTo(ForceVerdict.Pressed));
            Assert.That(touch.ForceNewtons, Is.EqualTo(1.5));
            Assert.That(After(null), Is.EqualTo(ForceVerdict.Pressed));
            now += 0.1;
            Assert.That(After(null), Is.EqualTo(ForceVerdict.Unknown));
            Assert.That(touch.ForceNewtons, Is.Zero);
            Assert.That(After(0.03), Is.EqualTo(ForceVerdict.Lifted), "the previous touch has ended");
        }

        [TestCase(double.NaN)]
        [TestCase(double.PositiveInfinity)]
        [TestCase(double.NegativeInfinity)]
        [TestCase(-0.5)]
        public void AnInvalidForceCountsAsADropout(double broken)
        {
            Assert.That(After(broken), Is.EqualTo(ForceVerdict.Unknown));
            After(1.0);
            Assert.That(After(broken), Is.EqualTo(ForceVerdict.Pressed));
            Assert.That(touch.ForceNewtons, Is.EqualTo(1.0));
            for (int frame = 0; frame < 10; ++frame)
            {
                After(broken);
            }
            Assert.That(touch.Verdict, Is.EqualTo(ForceVerdict.Unknown));
        }

        [Test]
        public void APenWithoutAMeasurementIsUnknown()
        {
            Assert.That(After(null), Is.EqualTo(ForceVerdict.Unknown));
            Assert.That(touch.Update(double.NaN, null), Is.EqualTo(ForceVerdict.Unknown));
        }

        [TestCase(0.02, false, ExpectedResult = true)]
        [TestCase(-0.02, false, ExpectedResult = true)]
        [TestCase(0.021, false, ExpectedResult = false)]
        [TestCase(-0.021, false, ExpectedResult = false)]
        [TestCase(0.024, true, ExpectedResult = true)]
        [TestCase(0.026, true, ExpectedResult = false)]
        [TestCase(double.NaN, true, ExpectedResult = false)]
        public bool TheNearDistanceAppliesOnBothSidesAndIsLongerForATouchedSurface(double metres, bool isTouched) =>
            touch.IsNear(metres, isTouched);

        private ForceVerdict After(double? forceNewtons)
        {
            now += FrameSeconds;
            return touch.Update(now, forceNewtons);
        }
    }
}
