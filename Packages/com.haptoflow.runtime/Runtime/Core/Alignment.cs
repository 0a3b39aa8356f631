#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using HaptoFlow.Files;
using HaptoFlow.Model;
using HaptoFlow.Numerics;

namespace HaptoFlow.Alignment
{
    /// <summary>The pose of an object after its three marked points were touched.</summary>
    /// <param name="Refusal">Why there is no pose, with the remedy; null with one.</param>
    internal sealed record AlignmentFit(string? Refusal, RigidPose Pose, double LargestErrorMetres)
    {
        public static AlignmentFit Refuse(string why) => new AlignmentFit(why, RigidPose.Identity, 0.0);
    }

    /// <summary>The rigid pose that maps three points of an object to the places where they were touched, with the
    /// least squared error. Any thread; a pure function.</summary>
    /// <remarks>Three points span a plane on each side; the best rotation maps plane to plane, and the remaining angle
    /// lies within it. The numbering of the points determines the plane's upper side.</remarks>
    internal static class ThreePointFit
    {
        /// <summary>With shorter sides, touching errors of millimetres cause a visible tilt.</summary>
        public const double MinimumSideMetres = 0.02;

        /// <summary>A flatter triangle does not determine the rotation about its longest side.</summary>
        public const double MinimumHeightMetres = 0.01;

        /// <summary>With larger errors the touched triangle is not the marked one.</summary>
        public const double MaximumErrorMetres = 0.01;

        private static readonly int[][] OtherOrders =
        {
            new[] { 0, 2, 1 }, new[] { 1, 0, 2 }, new[] { 1, 2, 0 }, new[] { 2, 0, 1 }, new[] { 2, 1, 0 },
        };

        /// <param name="marks">Three points of the object in its own frame, in metres.</param>
        /// <param name="touched">Positions of the tip's centre, in the same order, in metres.</param>
        /// <param name="outward">Direction out of the object at the marks, in its own frame: the pen's side.</param>
        /// <param name="tipRadiusMetres">Distance of the tip's centre from the touched place; 0 or more.</param>
        public static AlignmentFit Solve(
            IReadOnlyList<Double3> marks, IReadOnlyList<Double3> touched, Double3 outward, double tipRadiusMetres)
        {
            if (marks.Count != 3 || touched.Count != 3)
            {
                return AlignmentFit.Refuse("three marked and three touched points are needed");
            }
            string? refusal = WhyMarksUnusable(marks) ??
                WhyUnusable(touched, "touched", "Touch the marked points again");
            if (refusal != null)
            {
                return AlignmentFit.Refuse(refusal);
            }
            RigidPose pose = Fit(marks, touched);
            double error = LargestError(marks, touched, pose);
            return error > MaximumErrorMetres
                ? AlignmentFit.Refuse(WhyMismatched(marks, touched, error))
                : new AlignmentFit(null, WithoutTip(pose, marks, outward, tipRadiusMetres), error);
        }

        /// <summary>Why these marks do not determine a pose; null where they do.</summary>
        public static string? WhyMarksUnusable(IReadOnlyList<Double3> marks) => marks.Count != 3
            ? "three marked points are needed"
            : WhyUnusable(marks, "marked", "Mark points that are farther apart");

        private static RigidPose Fit(IReadOnlyList<Double3> marks, IReadOnlyList<Double3> touched)
        {
            RotationBasis from = BasisOf(marks);
            RotationBasis to = BasisOf(touched);
            Double3 markCentre = Centre(marks);
            Double3 touchedCentre = Centre(touched);
            double along = 0.0;
            double across = 0.0;
            for (int index = 0; index < 3; ++index)
            {
                Double3 mark = marks[index] - markCentre;
                Double3 place = touched[index] - touchedCentre;
                double markX = Double3.Dot(mark, from.First);
                double markY = Double3.Dot(mark, from.Second);
                double placeX = Double3.Dot(place, to.First);
                double placeY = Double3.Dot(place, to.Second);
                along += markX * placeX + markY * placeY;
                across += markX * placeY - markY * placeX;
            }
            double angle = Math.Atan2(across, along);
            var turned = new RotationBasis(Math.Cos(angle) * to.First + Math.Sin(angle) * to.Second, to.Third);
            Rotation rotation = RotationBasis.Between(from, turned);
            return new RigidPose(touchedCentre - rotation * markCentre, rotation);
        }

        /// <summary>Moves the object by the tip's radius, from the tip's centre to the touched place.</summary>
        private static RigidPose WithoutTip(
            in RigidPose pose, IReadOnlyList<Double3> marks, Double3 outward, double tipRadiusMetres)
        {
            Double3 normal = BasisOf(marks).Third;
            Double3 up = Double3.Dot(normal, outward) < 0.0 ? -normal : normal;
            double radius = tipRadiusMetres > 0.0 && Vectors.IsUsable(tipRadiusMetres) ? tipRadiusMetres : 0.0;
            return new RigidPose(pose.PositionMetres - radius * pose.DirectionToWorld(up), pose.Rotation);
        }

        private static RotationBasis BasisOf(IReadOnlyList<Double3> points)
        {
            Double3 first = Vectors.UnitOr(points[1] - points[0], Double3.Right);
            Double3 normal = Double3.Cross(points[1] - points[0], points[2] - points[0]);
            return new RotationBasis(first, Vectors.UnitOr(normal, Vectors.AnyPerpendicular(first)));
        }

        private static Double3 Centre(IReadOnlyList<Double3> points) => (points[0] + points[1] + points[2]) / 3.0;

        private static double LargestError(
            IReadOnlyList<Double3> marks, IReadOnlyList<Double3> touched, in RigidPose pose)
        {
            double largest = 0.0;
            for (int index = 0; index < 3; ++index)
            {
                largest = Math.Max(largest, Double3.Distance(pose.PointToWorld(marks[index]), touched[index]));
            }
            return largest;
        }

        private static string? WhyUnusable(IReadOnlyList<Double3> points, string which, string remedy)
        {
            double longest = 0.0;
            double shortest = double.PositiveInfinity;
            for (int index = 0; index < 3; ++index)
            {
                if (!Vectors.IsUsable(points[index]))
                {
                    return $"{which} point {Number(index)} is not a place. {remedy}";
                }
                double side = Double3.Distance(points[index], points[(index + 1) % 3]);
                longest = Math.Max(longest, side);
                shortest = Math.Min(shortest, side);
            }
            if (shortest < MinimumSideMetres)
            {
                return $"two {which} points are only {Millimetres(shortest)} apart, " +
                    $"{Millimetres(MinimumSideMetres)} are needed. {remedy}";
            }
            double height = Double3.Cross(points[1] - points[0], points[2] - points[0]).Length / longest;
            return height < MinimumHeightMetres
                ? $"the {which} points lie almost on one line: the third is {Millimetres(height)} beside it, " +
                    $"{Millimetres(MinimumHeightMetres)} are needed. {remedy}"
                : null;
        }

        private static string WhyMismatched(
            IReadOnlyList<Double3> marks, IReadOnlyList<Double3> touched, double error)
        {
            string what = $"the touched triangle differs from the marked one by {Millimetres(error)}.  ";
            foreach (int[] order in OtherOrders)
            {
                var reordered = new[] { touched[order[0]], touched[order[1]], touched[order[2]] };
                if (LargestError(marks, reordered, Fit(marks, reordered)) <= MaximumErrorMetres)
                {
                    return what + "It fits in another order: touch the points in the order of their numbers";
                }
            }
            return what + "Touch the three points again, exactly";
        }

        private static string Number(int index) => (index + 1).ToString(CultureInfo.InvariantCulture);

        private static string Millimetres(double metres) =>
            (1000.0 * metres).ToString("0.0", CultureInfo.InvariantCulture) + " mm";
    }

    /// <summary>Detects the place where a pen rests: pressed and still for a while. Averaging over that time is more
    /// accurate than one tracked position. One thread at a time; no garbage.</summary>
    internal sealed class TouchedPoint
    {
        public const double StillSeconds = 0.3;

        /// <summary>A tip farther than this from where it came to rest has moved.</summary>
        public const double StillMetres = 0.003;

        private const int MinimumSamples = 5;

        private Double3 anchor;
        private Double3 sum;
        private int count;
        private double beganSeconds;
        private bool taken;

        /// <summary>True once per rest: the tip must lift before the next.</summary>
        /// <param name="place">Mean position of the tip's centre, in metres.</param>
        public bool Update(double timeSeconds, Double3 tipMetres, bool pressed, out Double3 place)
        {
            place = tipMetres;
            if (!pressed || !Vectors.IsUsable(timeSeconds) || !Vectors.IsUsable(tipMetres))
            {
                count = 0;
                taken = taken && pressed;
                return false;
            }
            if (taken)
            {
                return false;
            }
            if (count == 0 || timeSeconds < beganSeconds || Double3.Distance(tipMetres, anchor) > StillMetres)
            {
                anchor = tipMetres;
                sum = Double3.Zero;
                count = 0;
                beganSeconds = timeSeconds;
            }
            sum += tipMetres;
            ++count;
            if (count < MinimumSamples || timeSeconds - beganSeconds < StillSeconds)
            {
                return false;
            }
            taken = true;
            place = sum / count;
            return true;
        }

        /// <summary>Ignores the present rest: the pen must lift first.</summary>
        public void AwaitLift()
        {
            count = 0;
            taken = true;
        }
    }

    /// <summary>A pose in a small JSON file: metres and a unit quaternion. Writing is atomic, and every value is
    /// checked on reading. Any thread that may access files.</summary>
    internal static class SavedPose
    {
        private const string Format = "haptoflow pose";
        private const int Version = 1;
        private const int MaximumFileBytes = 4096;
        private const double MaximumMetres = 1000.0;

        // Rounding to six decimals changes the length of a quaternion by less than this.
        private const double LengthTolerance = 1e-3;

        public static void Write(string path, in RigidPose pose)
        {
            Double3 place = pose.PositionMetres;
            Rotation turn = pose.Rotation;
            WholeFile.Write(path, JsonText.Of(new Dictionary<string, object?>
            {
                ["format"] = Format,
                ["version"] = Version,
                ["position_m"] = new[] { place.X, place.Y, place.Z },
                ["rotation_xyzw"] = new[] { turn.X, turn.Y, turn.Z, turn.W },
            }) + "\n");
        }

        /// <summary>False where there is no such file, or it cannot be used.</summary>
        public static bool TryRead(string path, out RigidPose pose, out string? problem)
        {
            pose = RigidPose.Identity;
            problem = null;
            if (!File.Exists(path))
            {
                return false;
            }
            try
            {
                if (new FileInfo(path).Length > MaximumFileBytes)
                {
                    throw new FormatException("the file is longer than 4096 bytes");
                }
                pose = Parse(JsonValue.Parse(File.ReadAllText(path)));
                return true;
            }
            catch (Exception error) when (error is FormatException || error is IOException ||
                error is UnauthorizedAccessException)
            {
                problem = $"{path}: {error.Message}; delete the file and align again";
                return false;
            }
        }

        private static RigidPose Parse(JsonValue document)
        {
            if (document["format"].AsText() != Format || document["version"].AsInteger() != Version)
            {
                throw new FormatException($"this is not a \"{Format}\" of version {Version}");
            }
            double[] place = Numbers(document["position_m"], 3, MaximumMetres);
            double[] turn = Numbers(document["rotation_xyzw"], 4, 1.0 + LengthTolerance);
            double length = Math.Sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2] + turn[3] * turn[3]);
            if (!(Math.Abs(length - 1.0) <= LengthTolerance))
            {
                throw new FormatException("rotation_xyzw is not of length 1");
            }
            return new RigidPose(
                new Double3(place[0], place[1], place[2]), new Rotation(turn[0], turn[1], turn[2], turn[3]));
        }

        private static double[] Numbers(JsonValue array, int count, double largest)
        {
            if (array.AsArray().Count != count)
            {
                throw new FormatException($"{array.Path} does not hold {count} numbers");
            }
            var numbers = new double[count];
            for (int index = 0; index < count; ++index)
            {
                numbers[index] = array[index].AsNumber();
                if (!(Math.Abs(numbers[index]) <= largest))
                {
                    throw new FormatException($"{array[index].Path} is out of range");
                }
            }
            return numbers;
        }
    }
}
