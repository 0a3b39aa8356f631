using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using HaptoFlow.Contact;
using HaptoFlow.Model;
using HaptoFlow.Numerics;
using HaptoFlow.Tests.Support;
using NUnit.Framework;

namespace HaptoFlow.RepositoryTests
{
    public sealed class GoldenContactTests
    {
        private const double Tolerance = 1e-5;

        private static readonly Lazy<JsonValue> File = new Lazy<JsonValue>(() =>
            JsonValue.Parse(System.IO.File.ReadAllText(RepositoryFiles.In("Tests", "Golden", "contact", "contact-states.json"))));

        // In Unity the physics engine finds the closest point of a mesh. All meshes of the file but a torus are boxes.
        private static IEnumerable<string> CaseNames() => File.Value["cases"].AsArray()
            .Select(testCase => testCase["name"].AsText()).Where(name => !name.Contains("torus"));

        [TestCaseSource(nameof(CaseNames))]
        public void ContactStatesAgreeWithTheNativeContactModel(string name)
        {
            JsonValue testCase = File.Value["cases"].AsArray().Single(each => each["name"].AsText() == name);
            var scene = new GoldenScene(testCase);
            IReadOnlyList<JsonValue> samples = testCase["stroke"]["samples"].AsArray();
            IReadOnlyList<JsonValue> readings = testCase["expected"]["readings"].AsArray();
            Assert.That(readings.Count, Is.EqualTo(samples.Count).And.GreaterThan(10));
            for (int frame = 0; frame < samples.Count; ++frame)
            {
                Compare(scene, testCase["expected"]["columns"], scene.Play(frame), readings[frame], frame);
            }
            CompareStatistics(scene.Tracker.Statistics, testCase["statistics"]);
        }

        private static void Compare(
            GoldenScene scene, JsonValue columns, in ContactReading reading, JsonValue expected, int frame)
        {
            for (int column = 0; column < columns.AsArray().Count; ++column)
            {
                string name = columns[column].AsText();
                Assert.That(scene.ValueOf(reading, name), Is.EqualTo(expected[column].AsNumber()).Within(Tolerance),
                    $"{name} of frame {frame}");
            }
        }

        private static void CompareStatistics(in ContactStatistics statistics, JsonValue expected)
        {
            Assert.That(statistics.Samples, Is.EqualTo((ulong)expected["samples"].AsInteger()));
            Assert.That(statistics.SanitisedSamples, Is.EqualTo((ulong)expected["sanitised_samples"].AsInteger()));
            Assert.That(statistics.Teleports, Is.EqualTo((ulong)expected["teleports"].AsInteger()));
            Assert.That(statistics.ClockRestarts, Is.EqualTo((ulong)expected["clock_restarts"].AsInteger()));
            Assert.That(statistics.TouchDowns, Is.EqualTo((ulong)expected["touch_downs"].AsInteger()));
        }
    }

    /// <summary>A case of the golden file, run through the tracker frame by frame.</summary>
    internal sealed class GoldenScene : IContactGeometry
    {
        private readonly JsonValue testCase;
        private readonly List<GoldenSurface> surfaces = new List<GoldenSurface>();
        private int played;

        public GoldenScene(JsonValue testCase)
        {
            this.testCase = testCase;
            JsonValue scene = testCase["scene"];
            Tracker = new ContactTracker(scene["stylus"]["tip_radius"].AsNumber()) { Geometry = this };
            foreach (JsonValue surface in scene["surfaces"].AsArray())
            {
                surfaces.Add(new GoldenSurface(surface, testCase["label_stiffness"]));
            }
            foreach (JsonValue moving in testCase["surface_poses"].AsArray())
            {
                surfaces[moving["surface_index"].AsInteger()].Poses = moving["poses"];
            }
        }

        public ContactTracker Tracker { get; }

        public bool TryClosest(ContactBody surface, Double3 tipMetres, out SurfacePoint found)
        {
            SurfacePoint? closest = surfaces.Find(each => each.Tracked == surface)!.Closest(Tracker, played, tipMetres);
            found = closest ?? default;
            return closest.HasValue;
        }

        public ContactReading Play(int frame)
        {
            played = frame;
            JsonValue row = testCase["stroke"]["samples"][frame];
            var position = new Double3(NumberOrNaN(row[1]), NumberOrNaN(row[2]), NumberOrNaN(row[3]));
            double? force = row[4].IsNull ? (double?)null : row[4].AsNumber();
            if (Tracker.BeginFrame(new TipSample(NumberOrNaN(row[0]), position, force)))
            {
                foreach (GoldenSurface surface in surfaces)
                {
                    surface.Offer(Tracker, frame);
                }
            }
            return Tracker.EndFrame();
        }

        public double ValueOf(in ContactReading reading, string column)
        {
            ContactBody? touched = reading.Surface;
            return column switch
            {
                "t" => reading.TimeSeconds,
                "surface_index" => touched == null ? -1 : surfaces.FindIndex(surface => surface.Tracked == touched),
                "touching" => reading.State.Touching ? 1.0 : 0.0,
                "touch_counter" => reading.State.TouchCounter,
                "px" => reading.PointMetres.X,
                "py" => reading.PointMetres.Y,
                "pz" => reading.PointMetres.Z,
                "nx" => reading.Normal.X,
                "ny" => reading.Normal.Y,
                "nz" => reading.Normal.Z,
                "penetration_m" => reading.PenetrationMetres,
                "vx_mps" => reading.State.FirstVelocityMps,
                "vy_mps" => reading.State.SecondVelocityMps,
                "approach_mps" => reading.State.ApproachSpeedMps,
                "force_n" => reading.State.ForceNewtons,
                "landing_counter" => reading.State.LandingCounter,
                "edge_counter" => reading.State.EdgeCounter,
                "edge_height_m" => reading.State.EdgeHeightMetres,
                "place_x" => reading.State.PlaceMetres.X,
                "place_y" => reading.State.PlaceMetres.Y,
                "place_z" => reading.State.PlaceMetres.Z,
                "first_x" => reading.State.FirstAxis.X,
                "first_y" => reading.State.FirstAxis.Y,
                "first_z" => reading.State.FirstAxis.Z,
                "second_x" => reading.State.SecondAxis.X,
                "second_y" => reading.State.SecondAxis.Y,
                "second_z" => reading.State.SecondAxis.Z,
                _ => throw new KeyNotFoundException($"the golden file has a column \"{column}\" that this test does not know"),
            };
        }

        private static double NumberOrNaN(JsonValue value) => value.IsNull ? double.NaN : value.AsNumber();
    }

    /// <summary>A surface of a golden scene: its shape, and its pose at each sample.</summary>
    internal sealed class GoldenSurface
    {
        private readonly JsonValue shape;
        private readonly RigidPose restingPose;
        private readonly Double3? boxSize;

        public GoldenSurface(JsonValue surface, JsonValue labelStiffness)
        {
            shape = surface["shape"];
            JsonValue? rotation = surface.Find("rotation");
            restingPose = new RigidPose(
                VectorOr(surface.Find("position"), Double3.Zero),
                rotation == null ? Rotation.Identity : RotationOf(rotation, 0));
            boxSize = shape.Find("box") is { } box ? VectorAt(box["size"], 0)
                : shape.Find("mesh") is { } mesh ? SizeOf(mesh["vertices"].AsArray())
                : (Double3?)null;
            Tracked = new ContactBody(VectorOr(surface.Find("grain"), Double3.Right), StiffnessOf(surface, labelStiffness));
        }

        public ContactBody Tracked { get; }

        public JsonValue? Poses { private get; set; }

        public void Offer(ContactTracker tracker, int frame)
        {
            RigidPose pose = PoseAt(frame);
            Tracked.Track.Record(tracker.NowSeconds, pose);
            Double3? from = tracker.AdvancePath(Tracked, pose);
            Double3 tip = pose.PointToLocal(tracker.TipMetres);
            SurfaceEntry? entry = from.HasValue ? EntryInto(from.Value, tip) : null;
            HeldFace held = tracker.HeldFaceOf(Tracked);
            held = entry.HasValue ? held.EnteredBy(entry.Value) : held;
            SurfacePoint? local = Closest(tip, held);
            if (entry.HasValue && !held.IsTouched &&
                !(local.HasValue && local.Value.BeyondMetres <= 0.0 && local.Value.SignedDistanceMetres <= 0.0))
            {
                local = entry.Value.PassedBy(tip);
            }
            if (local.HasValue && local.Value.SignedDistanceMetres <= tracker.ReachMetresOf(Tracked))
            {
                tracker.Consider(new ContactCandidate(Tracked, pose, local.Value, entry?.Share ?? 2.0));
            }
        }

        public SurfacePoint? Closest(ContactTracker tracker, int frame, Double3 tipMetres) =>
            Closest(PoseAt(frame).PointToLocal(tipMetres), tracker.HeldFaceOf(Tracked));

        private RigidPose PoseAt(int frame) => Poses == null
            ? restingPose
            : new RigidPose(VectorAt(Poses[frame], 0), RotationOf(Poses[frame], 3));

        private SurfacePoint? Closest(Double3 tip, in HeldFace held)
        {
            if (boxSize.HasValue)
            {
                return Shapes.OnBox(boxSize.Value, tip, held);
            }
            if (RoundSize() is { } round)
            {
                return Shapes.OnCapsule(round.Radius, round.Height, tip, held);
            }
            // Without another shape it is the half-space below y = 0.
            return new SurfacePoint(tip.With(1, 0.0), Double3.Up, tip.Y);
        }

        private SurfaceEntry? EntryInto(Double3 from, Double3 tip)
        {
            if (boxSize.HasValue)
            {
                return Shapes.EntryOfBox(boxSize.Value, from, tip);
            }
            if (RoundSize() is { } round)
            {
                return Shapes.EntryOfCapsule(round.Radius, round.Height, from, tip);
            }
            double share = from.Y / (from.Y - tip.Y);
            return from.Y < 0.0 || tip.Y >= 0.0
                ? (SurfaceEntry?)null
                : new SurfaceEntry((from + (tip - from) * share).With(1, 0.0), Double3.Up, share);
        }

        /// <summary>Radius and height of a sphere or a capsule.</summary>
        private (double Radius, double Height)? RoundSize()
        {
            if (shape.Find("sphere") is { } sphere)
            {
                return (sphere["radius"].AsNumber(), 0.0);
            }
            return shape.Find("capsule") is { } capsule
                ? (capsule["radius"].AsNumber(), capsule["height"].AsNumber())
                : ((double, double)?)null;
        }

        private static double StiffnessOf(JsonValue surface, JsonValue labelStiffness)
        {
            if (surface.Find("stiffness") is { } own)
            {
                return own.AsNumber();
            }
            double weighted = 0.0;
            double weights = 0.0;
            foreach ((string label, double weight) in MaterialOf(surface["material"]))
            {
                if (labelStiffness.Find(label) is { } stiffness)
                {
                    weighted += weight * stiffness.AsNumber();
                    weights += weight;
                }
            }
            return weights > 0.0 ? weighted / weights : 0.0;
        }

        private static IEnumerable<(string, double)> MaterialOf(JsonValue material)
        {
            try
            {
                return new[] { (material.AsText(), 1.0) };
            }
            catch (System.FormatException)
            {
                return material.AsObject().Select(entry => (entry.Key, entry.Value.AsNumber()));
            }
        }

        private static Double3 SizeOf(IReadOnlyList<JsonValue> vertices)
        {
            double Length(int axis) => 2.0 * vertices.Max(vertex => vertex[axis].AsNumber());
            return new Double3(Length(0), Length(1), Length(2));
        }

        private static Double3 VectorOr(JsonValue? value, Double3 fallback) => value == null ? fallback : VectorAt(value, 0);

        private static Double3 VectorAt(JsonValue row, int start) =>
            new Double3(row[start].AsNumber(), row[start + 1].AsNumber(), row[start + 2].AsNumber());

        private static Rotation RotationOf(JsonValue row, int start) => new Rotation(
            row[start].AsNumber(), row[start + 1].AsNumber(), row[start + 2].AsNumber(), row[start + 3].AsNumber());
    }

    /// <summary>Faces that turn on right behind an edge, or little: no box, ball or rod of the golden scenes has them.
    /// </summary>
    public sealed class ContactTransitionsTests
    {
        private const double TipRadiusMetres = 0.002;

        private readonly ContactTransitions transitions = new ContactTransitions();
        private readonly ContactBody body = new ContactBody(Double3.Right, 0.0);

        [SetUp]
        public void Forget() => transitions.Forget();

        [Test]
        public void BehindAnEdgeATurningFaceMovesTheReferenceAndASlideOffIsNoOtherEdge()
        {
            double SlideOffAt(double x, double y, double degrees) => transitions.SlideOff(
                At(x, y, degrees), new Double3(x + TipRadiusMetres, y, 0.0), TipRadiusMetres, 0.0, 0.05);

            Assert.That(EdgeAt(0.0, 0.0, 0.0), Is.Zero);
            Assert.That(EdgeAt(0.001, -0.001, 90.0), Is.EqualTo(TipRadiusMetres));
            Assert.That(SlideOffAt(0.001, -0.001, 150.0), Is.Zero, "the edge was felt");
            Assert.That(EdgeAt(0.001, -0.0035, 110.0), Is.Zero);
            Assert.That(SlideOffAt(0.001, -0.0035, 170.0), Is.EqualTo(TipRadiusMetres), "the face behind it ends");
        }

        [Test]
        public void AFaceThatTurnsLittleMovesTheReferenceAtOnceIfItIsRoundAndElseInTheThirdFrame()
        {
            EdgeAt(0.0, 0.0, 0.0);
            foreach (bool stays in new[] { true, true, false })
            {
                Assert.That(EdgeAt(0.007, 0.0, 20.0), Is.Zero);
                Assert.That(transitions.IsElsewhere(At(0.007, 0.0, 20.0), 0.0), Is.EqualTo(stays));
            }
            // On a rod of 20 mm.
            Assert.That(EdgeAt(0.013016, -0.003473, 40.0), Is.Zero);
            Assert.That(transitions.IsElsewhere(At(0.013016, -0.003473, 40.0), 0.0), Is.False);
        }

        private double EdgeAt(double x, double y, double degrees) =>
            transitions.Advance(At(x, y, degrees), TipRadiusMetres, 0.0, 0.0).EdgeHeightMetres;

        /// <param name="degrees">From the vertical to the normal.</param>
        private ContactCandidate At(double x, double y, double degrees)
        {
            double angle = degrees * Math.PI / 180.0;
            var normal = new Double3(Math.Sin(angle), Math.Cos(angle), 0.0);
            return new ContactCandidate(body, new RigidPose(Double3.Zero, Rotation.Identity),
                new SurfacePoint(new Double3(x, y, 0.0), normal, 0.0));
        }
    }

    /// <summary>What C# adds to the tip's velocity. The golden contact states hold the arithmetic to the native one, whose
    /// tests say what it does.</summary>
    public sealed class VelocityTests
    {
        private readonly RelativeVelocity relative = new RelativeVelocity();

        [Test]
        public void WhateverTheTrackerSaysTheVelocityIsFiniteAndNoFasterThanTheLimit()
        {
            var random = new Random(5);
            var path = new TipPath(new TrackerNoise());
            double time = 0.0;
            Double3 place = Double3.Zero;
            for (int frame = 0; frame < 50000; ++frame)
            {
                time += Math.Pow(10.0, -4.0 + 3.0 * random.NextDouble());
                if (random.Next(3) != 0)
                {
                    double metres = Math.Pow(10.0, -8.5 + 8.0 * random.NextDouble());
                    double Part() => metres * (random.NextDouble() - 0.5);
                    place += new Double3(Part(), Part(), Part());
                }
                path.Add(time, place, place);
                TipVelocity velocity = relative.Of(path);
                Assert.That(velocity.NowMps.Length, Is.LessThanOrEqualTo(20.0 * (1.0 + 1e-12)));
                Assert.That(velocity.ApproachMps.Length, Is.LessThanOrEqualTo(20.0 * (1.0 + 1e-12)));
            }
        }

        [Test]
        public void AnEndSpeedBeyondTheLimitIsTheLimit()
        {
            var path = new TipPath(new TrackerNoise());
            Double3 place = Double3.Zero;
            for (int frame = 0; frame < 9; ++frame)
            {
                // Each step as fast as allowed, and faster than the one before by as much as a hand can.
                place += new Double3((19.9 - 2.4 * (8 - frame)) / 90.0, 0.0, 0.0);
                path.Add(frame / 90.0, place, place);
            }
            Assert.That(relative.Of(path).NowMps.X, Is.EqualTo(20.0).Within(1e-9));
        }

        [Test]
        public void NoFrameAllocates()
        {
            var path = new TipPath(new TrackerNoise());
            long before = 0L;
            for (int frame = 0; frame < 2000; ++frame)
            {
                before = frame == 1000 ? GC.GetAllocatedBytesForCurrentThread() : before;
                var place = new Double3(0.01 * Math.Sin(0.2 * frame), 0.0, 0.0);
                path.Add(frame / 500.0, place, place);
                relative.Of(path);
            }
            Assert.That(GC.GetAllocatedBytesForCurrentThread() - before, Is.Zero);
        }
    }
}
