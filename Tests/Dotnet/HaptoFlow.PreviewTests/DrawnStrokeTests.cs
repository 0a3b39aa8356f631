using System;
using System.Linq;
using HaptoFlow.Preview;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    public sealed class DrawnStrokeTests
    {
        private static readonly DrawnPoint[] Nothing = Array.Empty<DrawnPoint>();

        /// <summary>Pointer events at uneven intervals.</summary>
        private static DrawnStroke Drawn(double seconds, Func<double, (double X, double Y)> path, double force = 1.0)
        {
            var drawn = new DrawnStroke();
            (double x, double y) = path(0.0);
            drawn.Begin(100.0, x, y, force, Nothing);
            int count = 0;
            for (double time = 0.007; time <= seconds; time += 0.007 + 0.004 * (count++ % 3))
            {
                (x, y) = path(time);
                drawn.Move(100.0 + time, x, y, force);
            }
            return drawn;
        }

        [Test]
        public void ADrawnCurveHasItsSpeedWithinAFewPercent()
        {
            Stroke stroke = DrawnStroke.Of(Drawn(1.5, time =>
                (0.06 + 0.02 * Math.Cos(5.0 * time), 0.04 + 0.02 * Math.Sin(5.0 * time))).Points);
            StrokeState[] inner = stroke.States.Where(state => state.Touching).Skip(2).SkipLast(2).ToArray();
            Assert.That(inner.Select(state => state.SpeedMps), Is.All.EqualTo(0.1).Within(0.004));
        }

        [Test]
        public void APauseOfThePointerIsAPauseOfTheStroke()
        {
            var drawn = new DrawnStroke();
            drawn.Begin(0.0, 0.02, 0.02, 1.0, Nothing);
            drawn.Move(0.02, 0.03, 0.02, 1.0);
            drawn.Move(0.52, 0.04, 0.02, 1.0);
            drawn.Move(0.54, 0.05, 0.02, 1.0);
            Stroke stroke = DrawnStroke.Of(drawn.Points);
            StrokeState resting = stroke.At(PresetStrokes.LeadSeconds + 0.3);
            Assert.That(resting.Touching, Is.True);
            Assert.That(resting.SpeedMps, Is.Zero);
            Assert.That(resting.XMetres, Is.EqualTo(0.03).Within(1e-6));
            Assert.That(stroke.At(PresetStrokes.LeadSeconds + 0.53).SpeedMps, Is.GreaterThan(0.2));
        }

        [Test]
        public void PointsOutsideThePatchMoveToItsEdge()
        {
            var drawn = new DrawnStroke();
            drawn.Begin(0.0, -1.0, 5.0, -3.0, Nothing);
            drawn.Move(0.01, 7.0, -0.5, 1.0);
            Assert.That((drawn.Points[0].XMetres, drawn.Points[0].YMetres), Is.EqualTo((0f, 0.08f)));
            Assert.That(drawn.Points[0].ForceNewtons, Is.Zero);
            Assert.That((drawn.Points[1].XMetres, drawn.Points[1].YMetres), Is.EqualTo((0.12f, 0f)));
        }

        [Test]
        public void EventsAtTheSameTimeAndAfterTwentySecondsAreIgnored()
        {
            var drawn = new DrawnStroke();
            drawn.Begin(3.0, 0.02, 0.02, 1.0, Nothing);
            drawn.Move(3.0, 0.03, 0.02, 1.0);
            drawn.Move(2.0, 0.03, 0.02, 1.0);
            drawn.Move(23.5, 0.03, 0.02, 1.0);
            Assert.That(drawn.Points.Count, Is.EqualTo(1));
        }

        [Test]
        public void AStrokeWithoutPointsHasNoContact()
        {
            Stroke stroke = DrawnStroke.Of(Nothing);
            Assert.That(stroke.States, Is.Not.Empty);
            Assert.That(stroke.States.Any(state => state.Touching), Is.False);
            Assert.That((stroke.MaximumSpeedMps, stroke.MaximumForceNewtons), Is.EqualTo((0.0, 0.0)));
        }
    }
}
