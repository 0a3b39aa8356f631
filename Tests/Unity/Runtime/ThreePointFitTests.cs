#nullable enable
using System;
using System.IO;
using System.Linq;
using HaptoFlow.Alignment;
using HaptoFlow.Numerics;
using NUnit.Framework;

namespace HaptoFlow.Tests
{
    /// <summary>The pose that maps three marked points to the places where they were touched.</summary>
    public sealed class ThreePointFitTests
    {
        private static readonly Double3[] Marks =
        {
            new Double3(0.0, 0.0, 0.0), new Double3(0.4, 0.0, 0.0), new Double3(0.0, 0.0, 0.25),
        };

        [Test]
        public void ExactTouchesReproduceThePoseForAThousandRandomPosesAndTriangles()
        {
            var random = new Random(5);
            for (int round = 0; round < 1000; ++round)
            {
                Double3[] marks = Enumerable.Range(0, 3).Select(_ => Anywhere(random, 0.5)).ToArray();
                var pose = new RigidPose(Anywhere(random, 10.0), new Rotation(
                    random.NextDouble() - 0.5, random.NextDouble() - 0.5, random.NextDouble() - 0.5,
                    random.NextDouble() - 0.5).Unit);
                AlignmentFit fit = Solve(marks, marks.Select(pose.PointToWorld).ToArray());
                if (fit.Refusal != null)
                {
                    Assert.That(fit.Refusal, Does.Contain("marked points"), "only an unusable triangle is refused");
                    continue;
                }
                Assert.That(fit.LargestErrorMetres, Is.LessThan(1e-9));
                Assert.That(Double3.Distance(fit.Pose.PositionMetres, pose.PositionMetres), Is.LessThan(1e-9));
                var probe = new Double3(0.3, -0.2, 0.7);
                Assert.That(Double3.Distance(fit.Pose.PointToWorld(probe), pose.PointToWorld(probe)), Is.LessThan(1e-9));
            }
        }

        [TestCase(1.0, 0.0, 0.0, 0.0)]
        [TestCase(0.0, 1.0, 0.0, 0.0)]
        [TestCase(0.0, 0.0, 1.0, 0.0)]
        [TestCase(0.0, 0.0, 0.0, 1.0)]
        [TestCase(0.5, 0.5, 0.5, 0.5)]
        [TestCase(-0.70710678, 0.0, 0.70710678, 0.0)]
        public void RotationsByHalfATurnAreFoundToo(double x, double y, double z, double w)
        {
            var pose = new RigidPose(new Double3(1.0, 2.0, 3.0), new Rotation(x, y, z, w));
            AlignmentFit fit = Solve(Marks, Marks.Select(pose.PointToWorld).ToArray());
            Assert.That(fit.Refusal, Is.Null);
            foreach (Double3 axis in new[] { Double3.Right, Double3.Up, Double3.Forward })
            {
                Assert.That(Double3.Distance(fit.Pose.DirectionToWorld(axis), pose.DirectionToWorld(axis)),
                    Is.LessThan(1e-7));
            }
        }

        [Test]
        public void NoOtherPoseNearbyFitsNoisyTouchesBetter()
        {
            var random = new Random(9);
            var pose = new RigidPose(new Double3(0.2, 1.0, -0.3), new Rotation(0.1, 0.2, -0.3, 0.9).Unit);
            Double3[] touched = Marks.Select(mark => pose.PointToWorld(mark) + Anywhere(random, 0.004)).ToArray();
            AlignmentFit fit = Solve(Marks, touched);
            Assert.That(fit.Refusal, Is.Null);
            double best = SquaredError(fit.Pose, touched);
            for (int round = 0; round < 2000; ++round)
            {
                Double3 turn = Anywhere(random, 0.01);
                var near = new RigidPose(fit.Pose.PositionMetres + Anywhere(random, 0.004),
                    new Rotation(turn.X, turn.Y, turn.Z, 1.0).Unit * fit.Pose.Rotation);
                Assert.That(SquaredError(near, touched), Is.GreaterThanOrEqualTo(best - 1e-12));
            }
        }

        [TestCase(1.0)]
        [TestCase(-1.0)]
        public void TheTipRadiusIsSubtractedOnThePensSide(double side)
        {
            var outward = new Double3(0.0, side, 0.0);
            AlignmentFit fit = ThreePointFit.Solve(
                Marks, Marks.Select(mark => mark + 0.002 * outward).ToArray(), outward, 0.002);
            Assert.That(Double3.Distance(fit.Pose.PositionMetres, Double3.Zero), Is.LessThan(1e-9));
        }

        [Test]
        public void TrianglesThatDoNotDetermineAPoseAreRefusedWithTheReason()
        {
            Refused(new[] { Marks[0], Marks[1], new Double3(0.2, 0.0, 0.009) }, Marks, "marked points lie almost on " +
                "one");
            Refused(Marks, new[] { Marks[0], Marks[1], new Double3(0.2, 0.0, 0.0) }, "touched points lie almost on " +
                "one");
            Refused(Marks, new[] { Marks[0], Marks[0], Marks[2] }, "two touched points are only 0.0 mm apart");
            Refused(new[] { Marks[0], new Double3(0.015, 0.0, 0.0), Marks[2] }, Marks, "only 15.0 mm apart");
            Refused(Marks, new[] { Marks[0], new Double3(double.NaN, 0.0, 0.0), Marks[2] }, "touched point 2 is not a");
            Refused(Marks, new[] { Marks[0], Marks[1] }, "three marked and three touched");
            Refused(Marks, new[] { Marks[0], 1.2 * Marks[1], Marks[2] }, "Touch the three points again, exactly");
            Refused(Marks, new[] { Marks[1], Marks[0], Marks[2] }, "in the order of their numbers");
        }

        private static void Refused(Double3[] marks, Double3[] touched, string part) =>
            Assert.That(Solve(marks, touched).Refusal, Does.Contain(part));

        private static AlignmentFit Solve(Double3[] marks, Double3[] touched) =>
            ThreePointFit.Solve(marks, touched, Double3.Up, 0.0);

        private static double SquaredError(RigidPose pose, Double3[] touched) => Enumerable.Range(0, 3)
            .Sum(index => Math.Pow(Double3.Distance(pose.PointToWorld(Marks[index]), touched[index]), 2.0));

        private static Double3 Anywhere(Random random, double reach) => new Double3(
            reach * (2.0 * random.NextDouble() - 1.0), reach * (2.0 * random.NextDouble() - 1.0),
            reach * (2.0 * random.NextDouble() - 1.0));
    }

    public sealed class TouchedPointTests
    {
        private TouchedPoint point = null!;
        private double now;

        [SetUp]
        public void TakeAPen()
        {
            point = new TouchedPoint();
            now = 0.0;
        }

        [Test]
        public void ARestingPenGivesItsMeanPositionOncePerRest()
        {
            int taken = 0;
            Double3 found = default;
            for (int frame = 0; frame < 90; ++frame)
            {
                var place = new Double3(1.0 + 0.001 * (frame % 2 == 0 ? 1.0 : -1.0), 2.0, 3.0);
                if (point.Update(now += 1.0 / 90.0, place, true, out Double3 mean))
                {
                    ++taken;
                    found = mean;
                }
            }
            Assert.That(taken, Is.EqualTo(1));
            Assert.That(Double3.Distance(found, new Double3(1.0, 2.0, 3.0)), Is.LessThan(1e-4));
            Assert.That(Rest(new Double3(1.0, 2.0, 3.0)), Is.False, "the pen was not lifted");
            point.Update(now += 0.01, default, false, out _);
            Assert.That(Rest(new Double3(1.0, 2.0, 3.0)), Is.True);
        }

        [Test]
        public void APenThatMovesOrHoversTakesNoPoint()
        {
            for (int frame = 0; frame < 180; ++frame)
            {
                var moving = new Double3(0.05 * now, 0.0, 0.0);
                Assert.That(point.Update(now += 1.0 / 90.0, moving, true, out _), Is.False);
            }
            for (int frame = 0; frame < 180; ++frame)
            {
                Assert.That(point.Update(now += 1.0 / 90.0, Double3.Zero, false, out _), Is.False);
            }
        }

        [Test]
        public void AnInvalidSampleRestartsTheRest()
        {
            for (int frame = 0; frame < 20; ++frame)
            {
                point.Update(now += 1.0 / 90.0, Double3.Zero, true, out _);
            }
            point.Update(now, new Double3(double.NaN, 0.0, 0.0), true, out _);
            Assert.That(point.Update(now += 0.2, Double3.Zero, true, out _), Is.False);
        }

        [Test]
        public void APressBeforeTheFirstLiftTakesNoPoint()
        {
            point.AwaitLift();
            Assert.That(Rest(Double3.Zero), Is.False);
        }

        private bool Rest(Double3 place)
        {
            bool taken = false;
            for (int frame = 0; frame < 60; ++frame)
            {
                taken |= point.Update(now += 1.0 / 90.0, place, true, out _);
            }
            return taken;
        }
    }

    /// <summary>A saved pose is read back unchanged, and a damaged file is refused.</summary>
    public sealed class SavedPoseTests
    {
        private const string Version1 = "{\"format\": \"haptoflow pose\", \"version\": 1, ";
        private string folder = "";
        private string path = "";

        [SetUp]
        public void MakeAFolder()
        {
            folder = Path.Combine(Path.GetTempPath(), "haptoflow-pose-" + Path.GetRandomFileName());
            path = Path.Combine(folder, "deep", "desk.json");
        }

        [TearDown]
        public void RemoveIt()
        {
            if (Directory.Exists(folder))
            {
                Directory.Delete(folder, true);
            }
        }

        [Test]
        public void ASavedPoseIsReadBackExactlyAlsoAfterOverwriting()
        {
            SavedPose.Write(path, RigidPose.Identity);
            var pose = new RigidPose(new Double3(0.1, -1.0 / 3.0, 1e-9), new Rotation(0.1, 0.2, -0.3, 0.9).Unit);
            SavedPose.Write(path, pose);
            Assert.That(SavedPose.TryRead(path, out RigidPose read, out string? problem), Is.True);
            Assert.That(problem, Is.Null);
            Assert.That(read.PositionMetres, Is.EqualTo(pose.PositionMetres));
            Assert.That(read.Rotation.W, Is.EqualTo(pose.Rotation.W).Within(1e-15));
            Assert.That(Directory.GetFiles(Path.GetDirectoryName(path)!), Has.Length.EqualTo(1), "no temporary file " +
                "remains");
        }

        [Test]
        public void AMissingFileIsNotAnError()
        {
            Assert.That(SavedPose.TryRead(path, out _, out string? problem), Is.False);
            Assert.That(problem, Is.Null);
        }

        [TestCase("")]
        [TestCase("{}")]
        [TestCase("{\"format\": \"haptoflow pose\", \"version\": 2, \"position_m\": [0, 0, 0], @")]
        [TestCase(Version1 + "\"position_m\": [0, 0], @")]
        [TestCase(Version1 + "\"position_m\": [0, 1e9, 0], @")]
        [TestCase(Version1 + "\"position_m\": [0, 0, 0], \"rotation_xyzw\": [0, 0, 0, 0]}")]
        [TestCase(Version1 + "\"position_m\": [0, 0, 0], \"rotation_xyzw\": [0, 0, 0, 1]")]
        public void ADamagedFileIsRefusedWithItsNameAndTheRemedy(string text)
        {
            Write(text.Replace("@", "\"rotation_xyzw\": [0, 0, 0, 1]}"));
            Assert.That(SavedPose.TryRead(path, out _, out string? problem), Is.False);
            Assert.That(problem, Does.StartWith(path).And.EndWith("align again"));
        }

        [Test]
        public void ATooLongFileIsNotRead()
        {
            Write(new string(' ', 5000));
            Assert.That(SavedPose.TryRead(path, out _, out string? problem), Is.False);
            Assert.That(problem, Does.Contain("longer"));
        }

        private void Write(string text)
        {
            Directory.CreateDirectory(Path.GetDirectoryName(path)!);
            File.WriteAllText(path, text);
        }
    }
}
