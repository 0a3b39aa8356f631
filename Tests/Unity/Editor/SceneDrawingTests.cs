#nullable enable
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Editor;
using HaptoFlow.Numerics;
using NUnit.Framework;

namespace HaptoFlow.EditorTests
{
    public sealed class ContactMarksTests
    {
        private static readonly Double3 Point = new Double3(1.0, 2.0, 3.0);

        [Test]
        public void TheArrowHeadLiesInTheSurfaceOnBothSidesOfTheShaft()
        {
            MarkLine[] arrow = Lines(MarkKind.Velocity, Contact()).ToArray();
            Assert.That(arrow, Has.Length.EqualTo(3));
            Double3 tip = arrow[0].To;
            Assert.That(Distance(arrow[1].From, tip) + Distance(arrow[2].From, tip), Is.Zero);
            Assert.That(arrow[1].To.Y, Is.EqualTo(Point.Y).Within(1e-12));
            Assert.That(arrow[2].To.Y, Is.EqualTo(Point.Y).Within(1e-12));
            Double3 middle = (arrow[1].To + arrow[2].To) * 0.5;
            Assert.That(Distance(middle, Point + (tip - Point) * 0.8), Is.LessThan(1e-12));
            Assert.That(Distance(arrow[1].To, arrow[2].To), Is.GreaterThan(0.005));
        }

        [Test]
        public void ThePenetrationLineIsAsLongAsThePenetrationDepth()
        {
            MarkLine depth = Lines(MarkKind.Penetration, Contact()).Single();
            Assert.That(Distance(depth.To, Point - Double3.Up * 0.0015), Is.LessThan(1e-12));
        }

        [Test]
        public void TheCrossLiesInTheSurfaceAroundThePoint()
        {
            MarkLine[] cross = Lines(MarkKind.Point, Contact()).ToArray();
            Assert.That(cross, Has.Length.EqualTo(2));
            foreach (MarkLine line in cross)
            {
                Assert.That(Distance((line.From + line.To) * 0.5, Point), Is.LessThan(1e-12));
                Assert.That(Double3.Dot(line.To - line.From, Double3.Up), Is.Zero.Within(1e-12));
            }
        }

        [Test]
        public void ARestingTipHasNoVelocityArrow()
        {
            MarkedContact resting = Contact();
            resting.TangentialVelocityMps = Double3.Zero;
            Assert.That(Lines(MarkKind.Velocity, resting), Is.Empty);
            Assert.That(ContactMarks.Of(resting).SelectMany(line => new[] { line.From, line.To })
                .All(place => !double.IsNaN(place.X + place.Y + place.Z)), Is.True);
        }

        [Test]
        public void TheCaptionNamesForceSpeedAndDepthWithUnits() =>
            Assert.That(ContactMarks.Caption(Contact()), Is.EqualTo("0.42 N, 500 mm/s, 1.5 mm deep"));

        private static MarkedContact Contact() => new MarkedContact
        {
            PointMetres = Point,
            Normal = Double3.Up,
            FirstAxis = Double3.Right,
            SecondAxis = Double3.Forward,
            TangentialVelocityMps = new Double3(0.3, 0.0, 0.4),
            PenetrationMetres = 0.0015,
            ForceNewtons = 0.42,
        };

        private static IEnumerable<MarkLine> Lines(MarkKind kind, in MarkedContact contact) =>
            ContactMarks.Of(contact).Where(line => line.Kind == kind);

        private static MarkLine Shaft(MarkKind kind, in MarkedContact contact) => Lines(kind, contact).First();

        private static double Distance(Double3 a, Double3 b) => (a - b).Length;
    }

    public sealed class LevelMeterTests
    {
        [TestCase(1f, 0.0)]
        [TestCase(0.1f, -20.0)]
        [TestCase(0.001f, -60.0)]
        [TestCase(1e-9f, -60.0)]
        [TestCase(0f, -60.0)]
        public void ALevelIsShownInDecibelsOfFullScale(float level, double decibels) =>
            Assert.That(LevelMeter.DecibelsOf(level), Is.EqualTo(decibels).Within(1e-4));

        [TestCase(0.0, 1f)]
        [TestCase(-30.0, 0.5f)]
        [TestCase(-60.0, 0f)]
        public void TheBarRangesFromMinusSixtyDecibelsToFullScale(double decibels, float share) =>
            Assert.That(LevelMeter.ShareOf(decibels), Is.EqualTo(share).Within(1e-6f));

        [Test]
        public void CaptionsAreCreatedOnce()
        {
            Assert.That(LevelMeter.CaptionOf(-12.4), Is.SameAs(LevelMeter.CaptionOf(-11.6)));
            Assert.That(LevelMeter.CaptionOf(-12.4), Is.EqualTo("level -12 dB of full scale"));
            Assert.That(LevelMeter.CaptionOf(-60.0), Is.EqualTo("silent"));
            Assert.That(LevelMeter.CaptionOf(0.0), Is.EqualTo("level 0 dB of full scale"));
        }
    }
}
