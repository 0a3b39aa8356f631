#nullable enable
using System;
using System.Collections;
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
            force.ForceNewtons = 0f;
            yield return Frames(5);
            Assert.That(stylus.IsTouching, Is.False);
            stylus.TouchBy = TouchDecision.Geometry;
            yield return Frames(2);
            Assert.That(stylus.IsTouching, Is.True);
            stylus.TouchBy = TouchDecision.MeasuredForce;
            yield return Frames(1);
            Assert.That(stylus.IsTouching, Is.False);
        }

        [UnityTest]
        public IEnumerator APenThatPressesFarFromEverySurfaceTouchesNothing()
        {
            Board();
            HapticStylus stylus = Pen(_ => new Vector3(0f, 0.03f, 0f));
            force.ForceNewtons = 2f;
            yield return Frames(5);
            Assert.That(stylus.IsTouching, Is.False);
            stylus.ForceDecision.NearMetres = 0.035f;
            yield return Frames(2);
            Assert.That(stylus.IsTouching, Is.True);
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
        public IEnumerator AShortDropoutIsBridgedAndAfterALongOneGeometryDecides()
        {
            Board();
            HapticStylus stylus = Pen(_ => new Vector3(0f, 0.006f, 0f));
            force.ForceNewtons = 1f;
            yield return Frames(5);
            force.HasNews = false;
            yield return Frames(2);
            Assert.That(stylus.IsTouching, Is.True);
            Assert.That(stylus.Contact.ForceNewtons, Is.EqualTo(1f).Within(1e-6f));
            yield return Frames(20);
            Assert.That(stylus.IsTouching, Is.False, "by geometry the tip is 4 mm above the surface");
            force.HasNews = true;
            yield return Frames(1);
            Assert.That(stylus.IsTouching, Is.True);
        }

        [UnityTest]
        public IEnumerator WithoutAForceSourceGeometryDecides()
        {
            Board();
            HapticStylus stylus = StylusAlong(_ => new Vector3(0f, 0.001f, 0f));
            stylus.TouchBy = TouchDecision.MeasuredForce;
            yield return Frames(3);
            Assert.That(stylus.IsTouching, Is.True);
            Assert.That(stylus.Contact.PenetrationMetres, Is.EqualTo(0.001f).Within(1e-5f));
        }

        [UnityTest]
        public IEnumerator ChangedThresholdsApplyAtOnceAndInvalidOnesAreCorrected()
        {
            Board();
            HapticStylus stylus = Pen(_ => new Vector3(0f, 0.006f, 0f));
            force.ForceNewtons = 0.3f;
            yield return Frames(2);
            Assert.That(stylus.IsTouching, Is.True);
            stylus.ForceDecision.PressNewtons = 0.5f;
            stylus.ForceDecision.ReleaseNewtons = 5f;
            yield return Frames(2);
            Assert.That(stylus.IsTouching, Is.False);
            force.ForceNewtons = 0.5f;
            yield return Frames(2);
            Assert.That(stylus.IsTouching, Is.True);
            force.ForceNewtons = 0.46f;
            yield return Frames(2);
            Assert.That(stylus.IsTouching, Is.True);
            force.ForceNewtons = 0.44f;
            yield return Frames(2);
            Assert.That(stylus.IsTouching, Is.False);
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
}
