#nullable enable
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using NUnit.Framework;

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
            for (int still = 0; still < 10; ++still)
            {
                Frame(new Double3(0.1, 0.001, 0.0), null, (low, 0.0));
            }
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
            for (int still = 0; still < 10; ++still)
            {
                Frame(new Double3(0.1, 0.001, 0.0), null, (low, 0.0));
            }
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
}
