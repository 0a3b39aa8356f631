using System;
using System.Linq;
using HaptoFlow.Preview;
using NUnit.Framework;

namespace HaptoFlow.PreviewTests
{
    internal sealed class StrokeTests
    {
        private static readonly StrokePreset[] Presets =
            Enum.GetValues(typeof(StrokePreset)).Cast<StrokePreset>().Where(preset => preset != StrokePreset.Drawn)
                .ToArray();

        private static readonly StrokeSettings Usual = new StrokeSettings(0.1, 1.0, 30.0, 2.0);

        private static StrokeState[] Touched(Stroke stroke) => stroke.States.Where(state => state.Touching).ToArray();

        [Test]
        public void EveryPresetStaysOnThePatchAndStartsAndEndsWithoutContact(
            [ValueSource(nameof(Presets))] StrokePreset preset, [Values(0.005, 0.1, 2.0)] double speedMps,
            [Values(0.0, 45.0, 90.0, 200.0)] double degrees)
        {
            Stroke stroke = PresetStrokes.Make(preset, new StrokeSettings(speedMps, 2.0, degrees, 1.5));
            Assert.That(stroke.States[0].Touching, Is.False);
            Assert.That(stroke.States[^1].Touching, Is.False);
            Assert.That(Touched(stroke), Is.Not.Empty);
            foreach (StrokeState state in Touched(stroke))
            {
                Assert.That(state.XMetres, Is.InRange(0.0, Stroke.PatchWidthMetres));
                Assert.That(state.YMetres, Is.InRange(0.0, Stroke.PatchHeightMetres));
                Assert.That(state.ForceNewtons, Is.InRange(0.0, 2.0 + 1e-9));
                Assert.That(state.SpeedMps, Is.LessThanOrEqualTo(speedMps * (1.0 + 1e-9)));
            }
        }

        [Test]
        public void TheVelocityOfEveryPresetIsTheDerivativeOfThePlaceAlongItsAxes(
            [ValueSource(nameof(Presets))] StrokePreset preset, [Values(0.0, 130.0)] double degrees)
        {
            Stroke stroke = PresetStrokes.Make(preset, new StrokeSettings(0.05, 1.0, degrees, 2.0));
            ContactState air = stroke.States[0].ContactOn(default);
            Assert.That((air.Touching, air.FirstVelocityMps, air.SecondVelocityMps, air.ForceNewtons),
                Is.EqualTo((false, 0f, 0f, 0f)));
            int compared = 0;
            for (int index = 1; index < stroke.States.Count - 1; ++index)
            {
                ContactState before = stroke.States[index - 1].ContactOn(default);
                ContactState now = stroke.States[index].ContactOn(default);
                ContactState after = stroke.States[index + 1].ContactOn(default);
                Assert.That(now.HasPlace, Is.EqualTo(now.Touching));
                if (!stroke.States[index].Continues || !stroke.States[index + 1].Continues)
                {
                    continue;
                }
                double seconds = 2.0 / Stroke.UpdateRateHz;
                double x = (after.PlaceMetres.X - before.PlaceMetres.X) / seconds;
                double z = (after.PlaceMetres.Z - before.PlaceMetres.Z) / seconds;
                Assert.That(now.FirstVelocityMps,
                    Is.EqualTo(x * now.FirstAxis.X + z * now.FirstAxis.Z).Within(1e-3));
                Assert.That(now.SecondVelocityMps,
                    Is.EqualTo(x * now.SecondAxis.X + z * now.SecondAxis.Z).Within(1e-3));
                ++compared;
            }
            Assert.That(compared, Is.GreaterThan(20));
        }

        [TestCase(StrokePreset.Slide)]
        [TestCase(StrokePreset.Spiral)]
        [TestCase(StrokePreset.Pressing)]
        public void StrokesOfConstantSpeedHaveThatSpeed(StrokePreset preset)
        {
            Stroke stroke = PresetStrokes.Make(preset, Usual);
            Assert.That(Touched(stroke).Select(state => state.SpeedMps), Is.All.EqualTo(0.1).Within(1e-9));
        }

        [Test]
        public void ASlideWrapsAtTheEdgesOfThePatch()
        {
            StrokeState[] states = Touched(PresetStrokes.Make(StrokePreset.Slide, Usual));
            Assert.That(states.Select(state => Math.Atan2(state.VelocityYMps, state.VelocityXMps)),
                Is.All.EqualTo(Math.PI / 6.0).Within(1e-9));
            int steps = states.Skip(1).Count(state => !state.Continues);
            Assert.That(steps, Is.GreaterThan(0), "200 mm do not fit on the patch");
            Assert.That(states.Select(state => state.TouchCounter), Is.All.EqualTo(1u), "wrapping does not end the touch");
        }

        [Test]
        public void TheSpeedOfAnAcceleratingStrokeRisesLinearly()
        {
            StrokeState[] states = Touched(PresetStrokes.Make(StrokePreset.Accelerating, Usual));
            Assert.That(states[0].SpeedMps, Is.LessThan(0.002));
            Assert.That(states[states.Length / 2].SpeedMps, Is.EqualTo(0.05).Within(0.001));
            Assert.That(states[^1].SpeedMps, Is.EqualTo(0.1).Within(0.002));
        }

        [Test]
        public void ASlowBackAndForthStrokeTurnsAtLeastFourTimes([Values(0.005, 0.1, 2.0)] double speedMps)
        {
            StrokeState[] states = Touched(
                PresetStrokes.Make(StrokePreset.BackAndForth, new StrokeSettings(speedMps, 1.0, 0.0, 2.0)));
            int turns = Enumerable.Range(1, states.Length - 1)
                .Count(index => Math.Sign(states[index].VelocityXMps) != Math.Sign(states[index - 1].VelocityXMps));
            Assert.That(turns, Is.GreaterThanOrEqualTo(4));
            Assert.That(states.Max(state => state.SpeedMps), Is.EqualTo(speedMps).Within(0.05 * speedMps));
        }

        [Test]
        public void ASpiralGrowsThroughEveryDirection()
        {
            StrokeState[] states = Touched(
                PresetStrokes.Make(StrokePreset.Spiral, new StrokeSettings(0.3, 1.0, 0.0, 2.0)));
            int quarters = states
                .Select(state => (state.VelocityXMps > 0.0, state.VelocityYMps > 0.0)).Distinct().Count();
            Assert.That(quarters, Is.EqualTo(4));
            double[] radii = states.Select(state => Math.Sqrt(
                Math.Pow(state.XMetres - 0.06, 2.0) + Math.Pow(state.YMetres - 0.04, 2.0))).ToArray();
            Assert.That(radii, Is.Ordered.Ascending);
            Assert.That(radii[^1], Is.EqualTo(0.032).Within(0.002));
        }

        [Test]
        public void TheForceOfAPressingStrokeRisesFromZero()
        {
            StrokeState[] states = Touched(PresetStrokes.Make(StrokePreset.Pressing, Usual));
            Assert.That(states[0].ForceNewtons, Is.LessThan(0.02));
            Assert.That(states[states.Length / 2].ForceNewtons, Is.EqualTo(0.5).Within(0.01));
            Assert.That(states.Max(state => state.ForceNewtons), Is.GreaterThan(0.97));
        }

        [Test]
        public void EachTapIsATouch()
        {
            Stroke stroke = PresetStrokes.Make(StrokePreset.Taps, Usual);
            uint touches = stroke.States[^1].TouchCounter;
            Assert.That(touches, Is.EqualTo(7u), "a tap every 320 ms for 2 s");
            for (uint touch = 1; touch <= touches; ++touch)
            {
                int states = Touched(stroke).Count(state => state.TouchCounter == touch);
                Assert.That(states, Is.InRange(5, 7), "80 ms at 72 Hz");
            }
        }

        [Test]
        public void OnlyTheRimsStrokeHasRimsEvery250Milliseconds()
        {
            Stroke stroke = PresetStrokes.Make(StrokePreset.Rims, Usual);
            Assert.That(stroke.States[stroke.States.Count - 1].EdgeCounter, Is.EqualTo(8u), "2 s of contact");
            Stroke slide = PresetStrokes.Make(StrokePreset.Slide, Usual);
            Assert.That(slide.States, Has.All.Matches<StrokeState>(state => state.EdgeCounter == 0u));
        }

        [Test]
        public void ATouchDownHasTheSpeedThatIsSet()
        {
            Stroke stroke = PresetStrokes.Make(StrokePreset.Taps, new StrokeSettings(0.1, 1.0, 0.0, 1.0, 0.7));
            Assert.That(stroke.States[20].ContactOn(default).ApproachSpeedMps, Is.EqualTo(0.7f));
        }

        [Test]
        public void ADrawnStrokeCannotBeMadeFromSettings() => Assert.That(
            () => PresetStrokes.Make(StrokePreset.Drawn, Usual), Throws.ArgumentException);

        [Test]
        public void TheStateAtATimeIsTheLatestUpdate()
        {
            Stroke stroke = PresetStrokes.Make(StrokePreset.Slide, Usual);
            Assert.That(stroke.At(-1.0).TimeSeconds, Is.Zero);
            Assert.That(stroke.At(10.5 / 72.0).TimeSeconds, Is.EqualTo(10.0 / 72.0));
            Assert.That(stroke.At(11.0 / 72.0).TimeSeconds, Is.EqualTo(11.0 / 72.0));
            Assert.That(stroke.At(99.0).TimeSeconds, Is.EqualTo(stroke.States[^1].TimeSeconds));
        }
    }

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
